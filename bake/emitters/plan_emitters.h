#pragma once

#include <vector>

#include "bake/emitters/lamps.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"

namespace opaline::bake {

struct EmitterPlan {
    std::vector<PlanEntry> entries;  ///< one a lamp; they belong to no rule
    std::vector<Lamp> lamps;         ///< those that are baked
};

/// Decides from the scene alone. Lamps are authored in nits and switched at run time, so no bound
/// relative to the environment leaves one out: bounds are unknown (NaN), or 0 where no surface is
/// there to be lit. `--effects` may leave all out.
EmitterPlan plan_emitters(const formats::Scene& scene, const Knobs& knobs);

}  // namespace opaline::bake
