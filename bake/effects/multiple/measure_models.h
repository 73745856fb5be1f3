#pragma once

#include <cstdint>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

/// A relative RMS error, measured before a bake at some receivers under white and three suns that
/// see each body from different sides. Both sides are Monte Carlo, each estimated twice, so that
/// noise does not count.
struct ModelError {
    double error = 0;
    std::uint32_t receivers = 0;  ///< 0: nothing was measured, as where walks carry no light
};

/// Of multiple scattering by the dipole against random walks. `traced` adds up.
ModelError measure_models(const EffectInputs& inputs, const MediumProfile& profile,
                          std::uint64_t& traced);

/// What one row for all views leaves of light of all orders: of walks from 16 vertices along the
/// views from which rows follow (ViewSet). A quarter of the weight is on the normal, as in the
/// self-check. Errors below 3 % drown in noise and are 0. `traced` adds up.
ModelError measure_views(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced);

}  // namespace opaline::bake
