#include "bake/pipeline/savings.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace opaline::bake {
namespace {

struct Cost {
    double seconds = 0;
    std::uint64_t bytes = 0;
};

Cost cost_of(const std::vector<PlanEntry>& plan, std::uint32_t material) {
    Cost cost;
    for (const PlanEntry& entry : entries_of(plan, material)) {
        cost.seconds += entry.predicted_seconds;
        cost.bytes += entry.predicted_bytes;
    }
    return cost;
}

bool is_saved(const PlanEntry& entry) {
    return entry.subject.kind == Subject::Kind::material && !entry.on && !entry.alternative;
}

}  // namespace

void predict_savings(const CostRequest& request, std::vector<PlanEntry>& plan) {
    std::set<std::string_view> rules;
    for (const PlanEntry& entry : plan) {
        if (is_saved(entry)) {
            rules.insert(entry.name);
        }
    }
    for (const std::string_view rule : rules) {
        std::vector<PlanEntry> other = plan;
        for (PlanEntry& entry : other) {
            if (entry.name == rule && is_saved(entry)) {
                entry.on = true;
                entry.terms = std::max(entry.terms, entry.least_terms);
            }
        }
        predict_costs(request, other);
        for (PlanEntry& entry : plan) {
            if (entry.name == rule && is_saved(entry)) {
                const Cost now = cost_of(plan, entry.subject.index);
                const Cost with = cost_of(other, entry.subject.index);
                entry.saved_seconds = std::max(0.0, with.seconds - now.seconds);
                entry.saved_bytes = with.bytes > now.bytes ? with.bytes - now.bytes : 0;
            }
        }
    }
}

}  // namespace opaline::bake
