#pragma once

#include <span>

#include "bake/base/context.h"
#include "bake/measure/check_point.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/visibility/ray_scene.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// Checks the diffuse ones among `points` against rays to the suns and dense quadrature of
/// everything else.
EffectCheck check_direct(const RayScene& rays, const formats::AssetView& asset,
                         std::span<const CheckPoint> points, std::span<const TestLight> lights,
                         const Context& context);

}  // namespace opaline::bake
