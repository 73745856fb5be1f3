#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "bake/effects/multiple/walks/walk_space.h"

namespace opaline::bake {

/// A walk flies as light of one group of bands does and serves all groups. Its weights are those of
/// the balance heuristic: the contribution of the path in a band over the sum of its densities in
/// all groups (Veach, Guibas 1995, eq. 9 and 10), so that no band's weight is ever larger than that
/// of walks of its own. The density in a group has the chance that a walk of its own survives.
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

    float sigma_t() const { return sigma_t_; }  ///< [1/m] of flights here; 0: to the next surface
    const std::array<float, 3>& value() const { return value_; }  ///< 0 in bands without light
    /// What is left of one walk: 1 at first, on average over all groups' walks.
    double left() const;
    /// The same of one band.
    double left(std::size_t band) const {
        return static_cast<double>(all_walks_) * static_cast<double>(value_[band]);
    }

    /// What absorption has taken since the last call, in the unit of `left`, band by band.
    std::array<double, 3> take_absorbed();

    /// The walk goes on in another of the space's media. It starts in the first.
    void enter(std::uint8_t medium);

    /// A flight of `length` [m] that ended in a collision, or at a surface. This and the following
    /// return false where no weight is left.
    bool fly(float length, bool collides);

    /// A walk of `length` [m] in the medium, with that many scatterings (whole), to a place where
    /// its flight goes on.
    bool cross_ball(float length, float scatterings);

    /// The first flight, toward a surface at `distance` [m]. In a group for which nearly all light
    /// would cross that, half of the walks collide before, with a density in proportion to light's.
    /// No first flight is changed where no surface is nearer than first_reach() [m]; none at all
    /// where a group's light is not scattered in the first medium.
    float first_reach() const { return first_reach_; }
    float first_crossing_chance(float distance) const;
    bool cross_first(float distance);
    bool collide_first(float length, float distance);

    bool absorb() { return absorb(medium_->albedo); }
    /// An event where the albedos of the bands are not the stated ones, of which each is >= it.
    bool absorb(const std::array<float, 3>& albedo);
    bool scale(float factor);
    /// Russian roulette; `u` uniform in [0, 1), any value where the walk is not at risk. False: the
    /// walk ends.
    bool survives(float u);
    bool is_at_risk() const { return survival_chance(flies_as_) < 1; }

  private:
    using PerGroup = std::array<float, 3>;
    PerGroup flight_factors(float length, bool collides, float scale) const;
    bool begin(const PerGroup& light, const PerGroup& density);
    float survival_chance(std::size_t group) const;
    bool reweigh(const PerGroup& light, const PerGroup& density);
    bool absorb_in_flight(float length);
    void lose(std::size_t band, float kept);

    const WalkSpace& space_;
    const WalkMedium* medium_;  // around the walk
    std::size_t groups_, flies_as_;
    float sigma_t_ = 0, first_reach_ = 0;
    PerGroup log_ratio_{};                // of the groups' extinction to that of the flights
    std::array<std::size_t, 3> group_{};  // of each band
    std::array<bool, 3> has_light_{};     // each band
    std::array<float, 3> value_{}, absorbed_{};
    PerGroup density_{};  // of the walk so far, times the group's walks; their sum is 1
    /// What walks of a band's own group would weigh that had come this way, and without absorption.
    std::array<float, 3> own_{};
    PerGroup own_full_{1, 1, 1};
    float all_walks_ = 0;
};

}  // namespace opaline::bake
