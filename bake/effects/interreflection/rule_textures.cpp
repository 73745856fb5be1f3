#include "bake/effects/interreflection/rule_textures.h"

#include <algorithm>
#include <cmath>

#include "bake/effects/interreflection/bounce_light.h"

namespace opaline::bake {
namespace {

constexpr double kCells = 4;  // in the width of the largest

// Nothing rises above its horizon. Of backs the horizon is not known.
bool is_unseen(const PlanInput& input) {
    return !input.material.sheet && !input.material.double_sided &&
           input.subject.horizon.elevation <= kLeastElevation;
}

}  // namespace

bool has_textures(const PlanInput& input) {
    return input.subject.textures.texels_per_metre > 0 && is_wanted(input.knobs, "interreflection");
}

PlanEntry decide_textures(const PlanInput& input) {
    PlanEntry entry;
    const TextureFacts& textures = input.subject.textures;
    const Surroundings& all = input.subject.surroundings;
    const double cell =
        kCells * std::sqrt(all.area / static_cast<double>(count_scatterers(input.knobs)));
    const bool is_unseen_here = is_unseen(input);
    const bool is_magnified = textures.texels_per_metre * cell <= 1;
    entry.bound = is_unseen_here || is_magnified ? 0 : all.brightest * textures.contrast;
    entry.on = is_worth(entry.bound, input, entry.forced);
    entry.reason = is_unseen_here ? "no other surface rises above its horizon"
                   : is_magnified ? "its texels are wider than what bounced light is averaged over"
                   : entry.on     ? "bounced light has the mean of its textures over areas"
                                  : "its textures hardly vary";
    return entry;
}

}  // namespace opaline::bake
