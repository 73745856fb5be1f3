#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/base/stage_log.h"
#include "bake/effects/layers/layer_tables.h"
#include "bake/plan/knobs.h"
#include "formats/opal/clouds.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What is baked of one layer.
struct LayerLayout {
    std::uint32_t layer = 0;  ///< index into Scene::layers
    bool cloud = true;        ///< what droplets do to light; false: the ground alone, and no more
    bool often = true;        ///< light that was scattered twice or more
    bool radiosity = true;    ///< ground and base light each other
};

/// What layers are baked from.
struct LayerJob {
    const formats::Scene& scene;
    std::span<const LayerLayout> layouts;
    const Knobs& knobs;
};

struct BakedLayers {
    formats::Clouds clouds;
    std::vector<DropletBands> droplets;  ///< of each layout; of no use where there is no cloud
};

/// The layers of a file; two stages in the log. The same bits for any number of threads.
/// Errors: `usage`, naming the layer, for droplets out of range; `interrupted`.
/// Precondition: every cloud has a thickness above 0 somewhere.
formats::Result<BakedLayers> bake_layers(const LayerJob& job, const Context& context,
                                         StageLog& log);

/// How finely radii are sampled with these knobs.
RadiusSampling radius_sampling(const Knobs& knobs);

}  // namespace opaline::bake
