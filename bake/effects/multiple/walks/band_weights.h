#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "bake/effects/multiple/walks/walk_space.h"

namespace opaline::bake {

/// A walk flies as light of one group of bands does and serves all groups. Its weights are those of
/// the balance heuristic: what the flights are worth in a band, over the sum of their densities in
/// all groups (Veach, Guibas 1995, eq. 9 and 10), so that no band's weight is ever larger than that
/// of walks of its own.
struct WalkGroup {
    std::uint32_t flies_as = 0;  ///< index into WalkSpace::bands
    /// Of each group: walks that fly as it does, in the unit for which sums of weights are means.
    std::array<float, 3> walks{1, 1, 1};
};

/// The weights of one walk, band by band.
class BandWeights {
  public:
    /// Precondition: the space has bands, and group.flies_as is one of them.
    BandWeights(const WalkSpace& space, const WalkGroup& group);

    float sigma_t() const { return sigma_t_; }                    ///< [1/m] of the flights
    const std::array<float, 3>& value() const { return value_; }  ///< 0 in bands without light
    float largest() const;
    /// The largest of a walk that has lost nothing to absorption.
    float full() const { return full_; }
    /// What is left of one walk: 1 at first, on average over all groups' walks.
    double left() const;

    /// A flight of `length` [m] that ended in a collision, or at a surface. These and the following
    /// return false where no weight is left.
    bool fly(float length, bool collides);

    /// The first flight, toward a surface at `distance` [m]. In a group for which nearly all light
    /// would cross that, half of the walks collide before, with a density in proportion to light's.
    /// No first flight is changed where no surface is nearer than first_reach() [m].
    float first_reach() const { return first_reach_; }
    float first_collision_chance(float distance) const;
    bool cross_first(float distance);
    bool collide_first(float length, float distance);

    bool absorb();
    bool scale(float factor);

  private:
    using PerGroup = std::array<float, 3>;
    PerGroup flight_factors(float length, bool collides) const;
    bool reweigh(const PerGroup& light, const PerGroup& density);

    const WalkSpace& space_;
    float sigma_t_, first_reach_ = 0;
    PerGroup log_ratio_{};                // of the groups' extinction to that of the flights
    std::array<std::size_t, 3> group_{};  // of each band
    std::array<float, 3> albedo_{};       // of each band
    std::array<float, 3> value_{};
    PerGroup density_{};  // of the walk so far, times the group's walks; their sum is 1
    float all_walks_ = 0, full_ = 0;
};

}  // namespace opaline::bake
