#pragma once

#include <vector>

#include "bake/plan/bake_plan.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Refuses (usage) a list of effects of which none concerns any surface of the scene: nothing would
/// be simulated.
formats::Status check_effects(const formats::Scene& scene, const Knobs& knobs);

/// Warnings for what was asked for and is not there in the end, or does nothing, with what was
/// decided instead. `plan` and `knobs`: as they were used.
std::vector<formats::Diagnostic> describe_unmet(const formats::Scene& scene,
                                                const BakeOptions& options, const Knobs& knobs,
                                                const std::vector<PlanEntry>& plan);

}  // namespace opaline::bake
