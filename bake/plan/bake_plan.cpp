#include "bake/plan/bake_plan.h"

#include <algorithm>

#include "bake/plan/plan_rules.h"

namespace opaline::bake {

std::vector<PlanEntry> plan_bake(const formats::Scene& scene, const SceneFacts& facts,
                                 const Knobs& knobs) {
    std::vector<PlanEntry> plan;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (facts.material[m].receivers == 0) {
            continue;
        }
        const PlanInput input{scene.materials[m], facts.material[m], knobs};
        for (const auto& rule : kPlanRules) {
            if (rule.applies(input)) {
                PlanEntry entry = rule.decide(input);
                entry.effect = rule.effect;
                if (entry.forced) {
                    entry.reason += "; forced: by its bound it would be left out";
                }
                entry.subject = "material '" + input.material.name + "'";
                entry.material = m;
                plan.push_back(std::move(entry));
            }
        }
    }
    return plan;
}

const PlanEntry* find_entry(const std::vector<PlanEntry>& plan, std::string_view effect,
                            std::uint32_t material) {
    const auto entry = std::find_if(plan.begin(), plan.end(), [&](const PlanEntry& e) {
        return e.effect == effect && e.material == material;
    });
    return entry == plan.end() ? nullptr : &*entry;
}

}  // namespace opaline::bake
