#include "bake/plan/savings.h"

#include <algorithm>
#include <set>
#include <string>

#include "bake/plan/cost_model.h"

namespace opaline::bake {
namespace {

struct Cost {
    double seconds = 0;
    std::uint64_t bytes = 0;
};

Cost cost_of(const std::vector<PlanEntry>& plan, std::uint32_t material) {
    Cost cost;
    for (const PlanEntry& entry : plan) {
        if (entry.material == material) {
            cost.seconds += entry.predicted_seconds;
            cost.bytes += entry.predicted_bytes;
        }
    }
    return cost;
}

}  // namespace

void predict_savings(const formats::Scene& scene, const SceneFacts& facts, const Knobs& knobs,
                     const Rates& rates, unsigned threads, std::vector<PlanEntry>& plan) {
    // A medium is opaque or translucent: its diffuse row replaces the others and adds nothing.
    const auto is_saved = [&](const PlanEntry& entry) {
        return !entry.on && !(entry.effect == "direct" && scene.materials[entry.material].medium);
    };
    std::set<std::string> effects;
    for (const PlanEntry& entry : plan) {
        if (is_saved(entry)) {
            effects.insert(entry.effect);
        }
    }
    for (const std::string& effect : effects) {
        std::vector<PlanEntry> other = plan;
        for (PlanEntry& entry : other) {
            if (entry.effect == effect && is_saved(entry)) {
                entry.on = true;
                // The fewest that depend on the view.
                entry.terms = std::max(entry.terms, entry.effect == "single.terms" ? 4u : 1u);
            }
        }
        predict_costs(scene, facts, knobs, rates, threads, other);
        for (PlanEntry& entry : plan) {
            if (entry.effect == effect && is_saved(entry)) {
                const Cost now = cost_of(plan, entry.material);
                const Cost with = cost_of(other, entry.material);
                entry.saved_seconds = std::max(0.0, with.seconds - now.seconds);
                entry.saved_bytes = with.bytes > now.bytes ? with.bytes - now.bytes : 0;
            }
        }
    }
}

}  // namespace opaline::bake
