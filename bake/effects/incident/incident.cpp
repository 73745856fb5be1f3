#include "bake/effects/incident/incident.h"

#include <array>

#include "bake/effects/incident/rule_colour.h"
#include "bake/effects/incident/rules_visibility.h"

namespace opaline::bake {
namespace {

constexpr std::array<DecisionRule, 2> kRules{
    {{"light.visibility", is_any_material, decide_visibility,
      [](const PlanEntry& entry, RowLayout& layout) { layout.occluded = entry.on; }},
     {"light.colour",
      [](const PlanInput& input) { return has_medium(input) || is_thin_walled(input); },
      decide_colour, [](const PlanEntry& entry, RowLayout& layout) { layout.grey = !entry.on; }}}};

}  // namespace

EffectDescriptor describe_incident(Effect id) {
    return {.id = id, .name = "incident", .rules = kRules, .acts = [](const RowLayout&) {
                return false;
            }};
}

}  // namespace opaline::bake
