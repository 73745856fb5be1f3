#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/measure/check_point.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/measure/truth.h"
#include "bake/translucent/translucent_rows.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// A medium's rows and what they are checked against. Multiple scattering against a Monte Carlo
/// estimate of the surface integral, with points and rays of its own, single scattering against
/// rays to twice the depth samples; both under the lights as they are.
struct MediumCheck {
    const formats::Scene& scene;
    const RayScene& rays;
    const TranslucentRecipe& recipe;
    std::uint32_t material = 0;
    TranslucentTruth truth;
    std::uint64_t seed = 0;  ///< of the truth's random numbers
};

/// `depth_samples`: of single scattering, as baked.
MediumCheck make_medium_check(const formats::Scene& scene, const RayScene& rays,
                              const TranslucentRecipe& recipe, std::uint32_t material,
                              std::uint32_t depth_samples, std::span<const TestLight> lights);

/// Checks, among kMostCheckedInMedia of `points`, those of the medium. Where multiple and single
/// scattering stand in one row they are checked together, and the effect is named
/// "multiple+single". Seen along the normal.
EffectCheck check_translucent(const MediumCheck& medium, const formats::AssetView& asset,
                              std::span<const CheckPoint> points, std::span<const TestLight> lights,
                              const Context& context);

}  // namespace opaline::bake
