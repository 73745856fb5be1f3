#include "bake/effects/specular/specular.h"

#include <algorithm>
#include <array>

namespace opaline::bake {
namespace {

PlanEntry decide(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    // At grazing angles everything is mirrored, where there is a boundary at all.
    const bool is_buried = input.subject.is_buried;
    entry.bound = medium.eta == 1 || is_buried ? 0 : 1;
    const bool is_surface = std::any_of(input.earlier.begin(), input.earlier.end(),
                                        [](const PlanEntry& e) { return e.as_surface; });
    if (!is_wanted(input.knobs, "specular")) {
        entry.reason = "left out by --effects";
    } else if (is_surface) {
        entry.reason = "the medium is shown as a diffuse surface, for comparison";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = is_buried
                           ? "its surface lies inside other media and is not seen"
                           : "the index of refraction is that of the air: nothing is mirrored";
    } else {
        entry.reason = "the boundary of the medium mirrors its surroundings";
    }
    return entry;
}

constexpr std::array<DecisionRule, 1> kRules{
    {{"specular", has_medium, decide,
      [](const PlanEntry& entry, RowLayout& layout) { layout.mirrors = entry.on; }}}};

}  // namespace

EffectDescriptor describe_specular(Effect id) {
    return {.id = id,
            .name = "specular",
            .help = "light mirrored at the boundary of media",
            .rules = kRules,
            .reads_openness = true};
}

}  // namespace opaline::bake
