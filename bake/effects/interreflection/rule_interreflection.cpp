#include "bake/effects/interreflection/rule_interreflection.h"

#include <algorithm>

namespace opaline::bake {

PlanEntry decide_interreflection(const PlanInput& input) {
    PlanEntry entry;
    const Surroundings& others = input.subject.surroundings;
    const Horizon& horizon = input.subject.horizon;
    // Light enters a medium anywhere on its facets, not only at vertices.
    const double above =
        horizon.elevation * horizon.elevation + (input.material.medium ? horizon.behind_facets : 0);
    const double covered = input.material.sheet ? 1 : std::min(1.0, above);
    const formats::Rgb c = input.material.base_color;
    const double sent =
        formats::is_metal(input.material)
            ? static_cast<double>(std::max({c.r, c.g, c.b}) * input.subject.brightest_vertex)
            : input.subject.brightest;
    entry.bound = sent * covered * others.brightest;
    entry.has_bands = !others.is_grey;
    const bool has_rows = std::any_of(input.earlier.begin(), input.earlier.end(),
                                      [](const PlanEntry& e) { return e.on && e.rule == 0; });
    if (!is_wanted(input.knobs, "interreflection")) {
        entry.reason = "not asked for by --effects";
    } else if (!has_rows) {
        entry.reason = "nothing else is simulated";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = covered < kMostElevation * kMostElevation
                           ? "no other surface rises above its horizon"
                           : "the surfaces of the scene reflect hardly anything";
    } else {
        entry.reason = "other surfaces, or other places of this one, send light to it";
    }
    return entry;
}

}  // namespace opaline::bake
