#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/translucent/translucent_rows.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// Checks, among the receivers `drawn`, those of the recipe's material. Multiple scattering against
/// the sum over every surface sample with what each lets in under each light before anything was
/// truncated (`transport.response` to the coarse vectors of `lights`); single scattering against
/// rays, every texel in four places and twice the depth samples, of every fourth receiver. Where
/// both stand in one row they are checked together, and the effect is named "multiple+single".
/// Seen along the normal. `points`: of all receivers.
EffectCheck check_translucent(const TranslucentRecipe& recipe, const formats::Scene& scene,
                              const RayScene& rays, std::uint32_t material,
                              std::uint32_t depth_samples, std::span<const BodyPoint> points,
                              const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                              std::span<const TestLight> lights, const Context& context);

}  // namespace opaline::bake
