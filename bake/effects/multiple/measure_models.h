#pragma once

#include <cstdint>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

/// White, and three suns that see each body from different sides: what is measured before a bake.
std::vector<TestLight> make_pilot_lights();

/// Error of the dipole in one body.
struct ModelErrors {
    double dipole = 0;            ///< relative RMS of multiple scattering
    std::uint32_t receivers = 0;  ///< at which it was measured; 0: it was not
};

/// Compares the dipole with random walks at some receivers, under a white sky and three suns of its
/// own: both by Monte Carlo, each estimated twice, so that noise does not count. `traced` adds up.
/// All 0 where walks carry no light.
ModelErrors measure_models(const EffectInputs& inputs, const MediumProfile& profile,
                           std::uint64_t& traced);

}  // namespace opaline::bake
