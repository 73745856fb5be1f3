#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace opaline::bake {

/// Where the light of walks went, by band, in walks. Every part of a walk's weight ends in exactly
/// one of these ways.
struct WalkEnds {
    std::array<double, 3> left{};      ///< the body, through its boundary, whether it counts or not
    /// The surface of another material, unscattered or where it is black.
    std::array<double, 3> met{};
    std::array<double, 3> absorbed{};  ///< by the media, and by things that reflected the rest
    std::array<double, 3> unfinished{};  ///< what lost, endless and buried walks still had

    double finished(std::size_t band) const { return left[band] + met[band] + absorbed[band]; }
    double all(std::size_t band) const { return finished(band) + unfinished[band]; }

    WalkEnds& operator+=(const WalkEnds& other);
};

/// What became of walks.
struct WalkCounts {
    std::uint64_t walks = 0;
    std::uint64_t events = 0;  ///< flights and jumps, in all
    std::uint64_t rays = 0;
    std::uint64_t jumps = 0;     ///< of the events: to the surface of a ball
    std::uint64_t searches = 0;  ///< for the nearest triangle
    std::uint64_t lost = 0;      ///< left the body's box: through a hole, or past an edge
    std::uint64_t endless = 0;   ///< given up after WalkSpace::most_events
    /// Given up where more media lie in each other than MediumStack holds.
    std::uint64_t buried = 0;
    /// Of light that scattered, and of light that did not: its `left` has crossed the body.
    WalkEnds ends, straight;
    /// Weight, band by band, in walks: that scattered at all, as it was before; and that crossed
    /// and counts as bright as the rest: at once, through a triangle of WalkStart::vertex, or as
    /// WalkOrders says.
    std::array<double, 3> scattered{}, filled{};

    /// Weight of unfinished walks, in walks, on average over the bands.
    double unfinished() const;
    /// Factor on finished walks that replaces the light of unfinished ones (README.md, "The
    /// estimator").
    double correction() const {
        const auto all = static_cast<double>(walks);
        const double missing = unfinished();
        return missing < 0.5 * all ? all / (all - missing) : 1;
    }
    /// Factor on the exits of a band with which what leaves, what meets other materials and what is
    /// absorbed after a scattering add up to what scatters (README.md, "Sums"). `fills_crossed`: to
    /// all light.
    double scale(std::size_t band, bool fills_crossed) const;
    /// Of all light of a band, the share that scatters, or is taken for such, by itself.
    double scattered_share(std::size_t band) const;
    /// The factor by which walks that scatter stand for those `filled`, of bands that count by
    /// `shares`. A quotient, as nearly all may cross: what scatters is known far better than 1 less
    /// what does not.
    double crossed_correction(const std::array<double, 3>& shares) const {
        double own = 0, other = 0;
        for (std::size_t b = 0; b < 3; ++b) {
            own += shares[b] * scattered[b];
            other += shares[b] * filled[b];
        }
        return own > 0 ? (own + other) / own : 1;
    }

    WalkCounts& operator+=(const WalkCounts& other);
};

}  // namespace opaline::bake
