#include "bake/effects/incident/rule_colour.h"

namespace opaline::bake {

PlanEntry decide_colour(const PlanInput& input) {
    PlanEntry entry;
    for (const PlanEntry& earlier : input.earlier) {
        // Parts bound the same light as their effect.
        if (!input.subject.is_grey && earlier.rule == 0 && earlier.on && earlier.has_bands) {
            entry.bound += earlier.bound;
        }
    }
    entry.on = is_worth(entry.bound, input, entry.forced);
    entry.reason = input.subject.is_grey ? "the three bands coincide"
                   : entry.on            ? "red, green and blue are scattered differently"
                                         : "hardly any scattered light is simulated";
    return entry;
}

}  // namespace opaline::bake
