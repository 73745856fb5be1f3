#include "bake/effects/incident/incident.h"

#include <algorithm>
#include <array>

#include "bake/plan/plan_input.h"

namespace opaline::bake {
namespace {

// Decides whether anything may occlude the light of a material's receivers. If nothing does, all
// light above the horizon arrives and no ray is traced. Surfaces up to an elevation e block at
// most this share of uniform light:
//     1/pi int_(elevation < e) (n.w) dw = sin^2 e;
// At a point of a convex body whose shading normal n is tilted against the facet's normal n_f, the
// facet blocks
//     1/pi int_(n.w > 0, n_f.w < 0) (n.w) dw = (1 - n.n_f) / 2.
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

constexpr std::array<DecisionRule, 2> kRules{
    {{"light.visibility", is_any_material, decide_visibility,
      [](const PlanEntry& entry, RowLayout& layout) { layout.occluded = entry.on; }},
     {"light.colour",
      [](const PlanInput& input) { return has_medium(input) || is_thin_walled(input); },
      decide_colour, [](const PlanEntry& entry, RowLayout& layout) { layout.grey = !entry.on; }}}};

}  // namespace

EffectDescriptor describe_incident(Effect id) {
    return {.id = id, .name = "incident", .rules = kRules};
}

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
