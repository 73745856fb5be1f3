#pragma once

#include <vector>

#include "bake/effects/layers/bake_layers.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/plan/effect.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Everything that a bake of a scene decides before it traces.
struct ScenePlan {
    SceneFacts facts;                ///< that decisions on materials were made from
    std::vector<PlanEntry> entries;  ///< on materials, volumes, layers, emitters, in this order
    // What is baked besides rows of materials.
    std::vector<VolumeLayout> volumes;
    std::vector<LayerLayout> layers;
    std::vector<Lamp> lamps;

    std::size_t count_emitters() const {
        return bake::count_emitters(lamps, count_glowing(volumes));
    }
};

/// `slots`: of vertices that share rows, or mix them (simplify_for_bake).
ScenePlan plan_scene(const EffectTable& effects, const formats::Scene& scene, formats::Slots slots,
                     const Knobs& knobs);

}  // namespace opaline::bake
