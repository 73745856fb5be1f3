#pragma once

#include <vector>

#include "bake/exchange/lamps/lamps.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"

namespace opaline::bake {

struct EmitterPlan {
    std::vector<PlanEntry> entries;  ///< one a lamp or volume that glows; they belong to no rule
    std::vector<Lamp> lamps;         ///< those that are baked
};

/// Decides from the scene alone. Lamps are authored in nits and switched at run time, so no bound
/// relative to the environment leaves one out: bounds are unknown (NaN), or 0 where no surface is
/// there to be lit. `--effects` may leave all out.
///
/// Volumes that glow come last. With D the largest radiance that one sends out and volumes scatter
/// of it along a line, Q / (pi d^2) that of the irradiance which its whole light of Q [W / sr]
/// gives at the distance d from the nearest surface, which bounds it where no volume scatters, and
/// rho the largest albedo of surfaces, no surface is brighter by its light than min(D, Q / (pi
/// d^2)) / (1 - rho): below the plan's least bound surfaces have no rows of it.
EmitterPlan plan_emitters(const formats::Scene& scene, const Knobs& knobs);

}  // namespace opaline::bake
