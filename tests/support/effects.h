#pragma once

#include <vector>

#include "bake/effects/effects.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/single/single_knobs.h"
#include "bake/pipeline/cost_model.h"
#include "bake/pipeline/pipeline.h"
#include "bake/pipeline/savings.h"

/// The functions that take a table of effects, with the table of the program.
namespace opaline::bake {

inline formats::Result<Knobs> resolve_knobs(const BakeOptions& options) {
    return resolve_knobs(all_effects(), options);
}

inline std::vector<PlanEntry> plan_bake(const formats::Scene& scene, const SceneFacts& facts,
                                        const Knobs& knobs) {
    return plan_bake(all_effects(), scene, facts, knobs);
}

inline std::vector<RowLayout> layout_rows(const formats::Scene& scene,
                                          const std::vector<PlanEntry>& plan, const Knobs& knobs) {
    return layout_rows(all_effects(), scene, plan, knobs);
}

inline formats::Result<BakeResult> run_bake(const formats::Scene& scene, const Knobs& knobs,
                                            const Context& context) {
    return run_bake(all_effects(), scene, knobs, context);
}

inline CostPrediction predict_costs(const formats::Scene& scene, const SceneFacts& facts,
                                    const Knobs& knobs, const StageRates& rates, unsigned threads,
                                    std::vector<PlanEntry>& plan) {
    return predict_costs({all_effects(), scene, facts, knobs, rates, threads}, plan);
}

inline void predict_savings(const formats::Scene& scene, const SceneFacts& facts,
                            const Knobs& knobs, const StageRates& rates, unsigned threads,
                            std::vector<PlanEntry>& plan) {
    predict_savings({all_effects(), scene, facts, knobs, rates, threads}, plan);
}

/// All light but that of other surfaces, whose rays are random: keyed by seed and place, and
/// coloured by others.
inline void leave_bounces_out(BakeOptions& options) {
    for (const EffectDescriptor& effect : all_effects().effects) {
        if (!effect.help.empty() && effect.name != "interreflection") {
            options.effects.emplace_back(effect.name);
        }
    }
}

/// Every shortcut forced off: what a bake with shortcuts is compared with. Without a list of
/// effects all light but that of other surfaces.
inline void simulate_all_but_bounces(BakeOptions& options) {
    options.simulate_all = true;
    if (options.effects.empty()) {
        leave_bounces_out(options);
    }
}

}  // namespace opaline::bake
