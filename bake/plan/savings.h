#pragma once

#include <vector>

#include "bake/plan/bake_plan.h"
#include "bake/plan/rates.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Fills in the plan's saved_seconds and saved_bytes: what the material of an entry that is off
/// would take more if it were on, all else as planned. What all materials share is left out of it.
/// Arguments as predict_costs', which must have filled in the plan before. One prediction for each
/// effect of which something is off.
void predict_savings(const formats::Scene& scene, const SceneFacts& facts, const Knobs& knobs,
                     const Rates& rates, unsigned threads, std::vector<PlanEntry>& plan);

}  // namespace opaline::bake
