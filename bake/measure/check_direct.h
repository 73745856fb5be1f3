#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/receivers/receiver.h"
#include "bake/visibility/ray_scene.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// Checks the diffuse ones among the receivers `drawn` (indices over the whole asset, ascending)
/// against rays to the suns and dense quadrature of everything else.
EffectCheck check_direct(const RayScene& rays, std::span<const Receiver> receivers,
                         const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                         std::span<const TestLight> lights, const Context& context);

}  // namespace opaline::bake
