#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/site_rows.h"
#include "bake/plan/dense_rows.h"

namespace opaline::bake {

/// Adds up rows of sites with one row, weighted for several rows of a receiver at once.
class SiteRowSum {
  public:
    static constexpr std::size_t kMostRows = 9;
    /// `texels` of a row; `rows` of the receiver, at most kMostRows; `bands` as of the sites.
    SiteRowSum(std::size_t texels, std::uint32_t rows, std::uint32_t bands);

    using Weights = std::array<std::array<float, 3>, kMostRows>;  ///< of each row, per band
    void add(const SiteRows& from, std::size_t site, const Weights& weights);

    float at(std::uint32_t row, std::size_t texel, std::uint32_t band) const {
        return sums()[lanes_ * texel + lane(row, band)];
    }
    /// What a term of a receiver takes of each row.
    struct Share {
        std::uint32_t term = 0;
        std::array<float, kMostRows> of_row{};
    };
    /// Adds to each of these terms its shares of the rows. Precondition: `to` has the texels and
    /// bands of this.
    void add_to(std::span<const Share> shares, const DenseRow& to) const;

  private:
    // A line of the cache: a texel whose rows and bands fill it is read and written at once.
    struct alignas(64) Line {
        std::array<float, 16> value{};
    };
    // Of a texel: its rows side by side, four floats each (one with one band).
    std::size_t lane(std::uint32_t row, std::uint32_t band) const {
        return bands_ == 1 ? row : 4 * std::size_t{row} + band;
    }
    const float* sums() const { return lines_.front().value.data(); }

    std::uint32_t rows_, bands_;
    std::size_t texels_, lanes_;
    std::vector<Line> lines_;
};

}  // namespace opaline::bake
