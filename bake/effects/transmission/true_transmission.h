#pragma once

#include <cstdint>
#include <span>

#include "bake/effects/transmission/straight_paths.h"
#include "bake/transport/other_light.h"
#include "bake/truth/luminance.h"
#include "bake/truth/true_irradiance.h"

namespace opaline::bake {

/// What random views of a receiver see of the published lights.
struct StraightTruth {
    std::span<const TestLight> lights;
    SmoothLights smooth;
    std::uint32_t views = 0;  ///< for each of the two estimates
    std::uint32_t terms = 1;  ///< harmonics of the view
    /// What surfaces send that stand before the sky; empty: they are black.
    OtherLight::TrueView surfaces{};
};

/// Luminance toward `toward`, unit, inside (0: the receiver's normal), less the factor F_t, of
/// light that crosses the body straight, as the harmonics hold it: random views, that look at the
/// lights themselves. No cube map, wavelets or spiral of the bake. Around exits the lights are
/// spread over 5 degrees, because no view meets a sun's disc; so bakes do by more or less. `key`:
/// of the random numbers.
TwoEstimates see_lights_through(const StraightBody& body, const StraightTruth& truth,
                                const BodyPoint& point, glm::vec3 toward, std::uint64_t seed,
                                std::uint32_t key, std::uint64_t& traced);

}  // namespace opaline::bake
