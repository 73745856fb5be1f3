#include "bake/plan/rule_colour.h"

#include "bake/plan/rule_multiple.h"
#include "bake/plan/rules_single.h"

namespace opaline::bake {

PlanEntry decide_colour(const PlanInput& input) {
    const auto simulated = [](const PlanEntry& effect) { return effect.on ? effect.bound : 0.0; };
    PlanEntry entry;
    entry.bound = input.subject.is_grey
                      ? 0
                      : simulated(decide_multiple(input)) + simulated(decide_single(input));
    entry.on = is_worth(entry.bound, input, entry.forced);
    entry.reason = input.subject.is_grey ? "the three bands coincide"
                   : entry.on            ? "the medium treats red, green and blue differently"
                                         : "hardly any scattered light of the medium is simulated";
    return entry;
}

}  // namespace opaline::bake
