#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/plan/knobs.h"
#include "bake/plan/row_layout.h"
#include "bake/receivers/receiver.h"
#include "bake/translucent/media_stages.h"
#include "bake/visibility/ray_scene.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// What a finished file was baked from.
struct SelfCheck {
    const formats::Scene& scene;
    const RayScene& rays;
    std::span<const Receiver> receivers;  ///< without a normal where no diffuse row is simulated
    std::span<const BodyPoint> points;    ///< of all vertices
    std::span<const RowLayout> layouts;   ///< by material
    const MediaStages& media;
    const Knobs& knobs;
    std::span<const TestLight> lights;  ///< of the asset's cube map
};

/// Compares the file with the truth at held-back receivers and at as many random points of the
/// surface, where the file is interpolated as the runtime does. `traced` adds up.
ErrorReport check_file(const SelfCheck& baked, const formats::AssetView& asset,
                       const Context& context, std::uint64_t& traced);

}  // namespace opaline::bake
