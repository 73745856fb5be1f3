#include "bake/effects/incident/rules_visibility.h"

#include <algorithm>

namespace opaline::bake {

PlanEntry decide_visibility(const PlanInput& input) {
    PlanEntry entry;
    const Horizon& horizon = input.subject.horizon;
    const double below = horizon.elevation * horizon.elevation;
    if (input.material.sheet) {
        entry.bound = 1;  // what rises above the horizon of the back is not known
    } else if (input.material.medium) {
        // Light enters anywhere on the facets, not only at vertices.
        entry.bound = std::min(1.0, below + horizon.behind_facets);
    } else {
        const formats::Rgb c = input.material.base_color;
        entry.bound =
            below * static_cast<double>(std::max({c.r, c.g, c.b}) * input.subject.brightest_vertex);
    }
    entry.on = is_worth(entry.bound, input, entry.forced);
    entry.reason = input.material.sheet || horizon.elevation > kMostElevation
                       ? "other surfaces, or other places of this one, may stand before the light"
                   : entry.bound >= kLeastBound
                       ? "the facets are so coarse that they shade their own normals"
                       : "nothing rises above the horizon of any vertex: all of its light arrives";
    return entry;
}

}  // namespace opaline::bake
