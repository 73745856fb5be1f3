#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/translucent/translucent_rows.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// Checks, among 256 of the receivers `drawn`, those of the recipe's material. Multiple scattering
/// against a Monte Carlo estimate of the surface integral, with points and rays of its own, single
/// scattering against rays to twice the depth samples; both under the lights as they are. Where
/// both stand in one row they are checked together, and the effect is named "multiple+single".
/// Seen along the normal. `points`: of all receivers.
EffectCheck check_translucent(const TranslucentRecipe& recipe, const formats::Scene& scene,
                              const RayScene& rays, std::uint32_t material,
                              std::uint32_t depth_samples, std::span<const BodyPoint> points,
                              const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                              std::span<const TestLight> lights, std::uint64_t seed,
                              const Context& context);

}  // namespace opaline::bake
