#include "bake/pipeline/plan_scene.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "bake/effects/emitters/plan_emitters.h"
#include "bake/effects/layers/plan_layers.h"
#include "bake/scene/inspect_scene.h"

namespace opaline::bake {

ScenePlan plan_scene(const EffectTable& effects, const formats::Scene& scene, formats::Slots slots,
                     const Knobs& knobs) {
    VolumePlan volumes = plan_volumes(scene, knobs);
    LayerPlan layers = plan_layers(scene, knobs);
    EmitterPlan emitters = plan_emitters(scene, knobs);
    ScenePlan plan{inspect_scene(scene, std::move(slots)),
                   {},
                   std::move(volumes.layouts),
                   std::move(layers.layouts),
                   std::move(emitters.lamps)};
    plan.entries = plan_bake(effects, scene, plan.facts, knobs);
    for (auto* const entries : {&volumes.entries, &layers.entries, &emitters.entries}) {
        std::ranges::move(*entries, std::back_inserter(plan.entries));
    }
    return plan;
}

}  // namespace opaline::bake
