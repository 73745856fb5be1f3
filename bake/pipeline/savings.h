#pragma once

#include <vector>

#include "bake/pipeline/cost_model.h"

namespace opaline::bake {

/// Fills in the plan's saved_seconds and saved_bytes: what the subject of an entry that is off
/// would take more if it were on, all else as planned. What all subjects share is left out of it.
/// predict_costs must have filled in the plan before. One prediction for each rule of which
/// something is off.
void predict_savings(const CostRequest& request, std::vector<PlanEntry>& plan);

}  // namespace opaline::bake
