#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/exit_lobe.h"
#include "bake/effects/multiple/walks/sparse_vectors.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// A row of a body's light: four floats per texel, rgb-, or one where all bands are equal.
struct TexelRow {
    std::span<float> values;
    std::size_t step = 4;  ///< or 1
};

/// Lobes of degree two at exits, constant within each of 96 parts of the sphere, the texels of a
/// cube map of 4 x 4 a face, 22 degrees wide (README.md, "The light at an exit"): what an exit sees
/// of a sample's light is the sum over cells of the light times the lobe's weight there. Even light
/// is exact, and so is unoccluded light of the lobe's functions.
class ExitCells {
  public:
    static constexpr std::uint32_t kSide = 4, kCount = 6 * kSide * kSide;
    /// Beside 1: the three coordinates of w, and its square.
    static constexpr std::size_t kFunctions = 8;
    /// Weights of exits of one sample, rgb-: their sum, and that of weights times each function of
    /// their direction, less its mean.
    using Sums = std::array<glm::vec4, 1 + kFunctions>;
    using Cells = std::array<std::array<float, kCount>, 3>;  ///< light of cells, band by band
    using Functions = std::array<float, kFunctions>;

    /// `cubemap_size` of the vectors that are added, a power of two; `lobe` of the boundary; cells
    /// are made ready for the samples' normals.
    ExitCells(std::span<const SurfaceSample> samples, std::uint32_t cubemap_size,
              const ExitLobe& lobe);

    const ExitLobe& lobe() const { return lobe_; }

    /// Adds an exit at a sample with that weight, rgb-.
    void add_exit(std::uint32_t sample, const ExitDirection& direction, glm::vec4 weight,
                  Sums& sums) const;

    /// Averages over cells of a Haar vector of one band.
    using Averages = std::array<float, kCount>;
    Averages averages_of(const SparseVector& vector) const;

    /// Adds a sample's Haar vector of one band as its exits see it: details to a row, averages of
    /// cells to `cells`. `averages`: of that vector.
    void add(std::uint32_t sample, const SparseVector& vector, const Averages& averages,
             const Sums& sums, const TexelRow& row, Cells& cells) const;

    /// Adds averages of cells to a row.
    void add_cells(const Cells& cells, const TexelRow& row) const;

  private:
    // Of samples with nearly the same normal.
    struct Table {
        Functions mean;  // under p
        // Of each function and cell, times those of w_e, less their mean.
        std::array<std::array<float, kCount>, kFunctions> reproduces;
    };
    // Of a cell, for the horizon that cuts it.
    struct Part {
        glm::vec3 direction;
        float solid_angle;  // [sr]
        Functions value;
    };
    float transmittance(float cosine) const;  // from outside, into the body
    Table make_table(glm::vec3 normal, std::span<const Part> parts) const;

    ExitLobe lobe_;
    std::uint32_t size_;
    std::vector<std::uint8_t> cell_;    // of each Haar function; kCount: of the averages of cells
    std::vector<float> transmittance_;  // by the cosine
    std::vector<Table> tables_;
    std::vector<std::uint32_t> table_;  // of each sample
};

}  // namespace opaline::bake
