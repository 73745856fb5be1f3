#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace opaline::bake {

/// How a series of bounces ended.
struct SolveReport {
    std::uint32_t bounces = 0;  ///< that were followed
    double remaining = 0;       ///< share of all light that comes after them, by extrapolation
};

/// The end of a series of bounces. After some of them each is the one before times the same ratio
/// q, that of the whole scene, so that those after a bounce are q / (1 - q) times that bounce. Each
/// band has its own q.
class SeriesEnd {
  public:
    /// Of a closed room that absorbs nothing there is no finite sum: no bounce counts as more than
    /// this times the one before.
    static constexpr double kLargestRatio = 0.999;

    /// `sums`: by band, of all light so far. First of what is emitted, then after each bounce.
    void add(std::span<const double> sums);
    /// What comes after a bounce, in its multiples.
    double rest(std::size_t band) const { return ratio(band) / (1 - ratio(band)); }
    double ratio(std::size_t band) const;
    /// Share of all light that comes after the next bounce; 1 where no bounce was added yet.
    double remaining() const;
    /// Whether the next bounce has at most `least` of what was emitted, and what follows it at most
    /// that of all light. Both, because places that face themselves fade later than the whole.
    bool is_settled(double least) const;

  private:
    std::uint32_t count_ = 0;
    std::array<double, 3> emitted_{}, all_{}, last_{}, before_{};
};

}  // namespace opaline::bake
