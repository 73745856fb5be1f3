#include "bake/emitters/plan_emitters.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bake/plan/plan_input.h"

namespace opaline::bake {

EmitterPlan plan_emitters(const formats::Scene& scene, const Knobs& knobs) {
    EmitterPlan plan;
    const bool has_surfaces =
        std::ranges::any_of(scene.primitives, [](const auto& p) { return !p.index.empty(); });
    std::uint32_t number = 0;
    for (Lamp& lamp : list_lamps(scene)) {
        PlanEntry entry;
        entry.name = "emitters";
        entry.subject = {Subject::Kind::emitter, number++, "emitter '" + lamp.name + "'"};
        entry.has_bands = true;
        entry.bound = has_surfaces ? std::numeric_limits<double>::quiet_NaN() : 0;
        entry.on = has_surfaces && is_wanted(knobs, entry.name);
        entry.reason = entry.on       ? (lamp.lights.empty() ? "its surfaces glow: rows of its own"
                                                             : "it sends out light: rows of its own")
                       : has_surfaces ? "left out by --effects"
                                      : "there is no surface that it could light";
        if (entry.on) plan.lamps.push_back(std::move(lamp));
        plan.entries.push_back(std::move(entry));
    }
    return plan;
}

}  // namespace opaline::bake
