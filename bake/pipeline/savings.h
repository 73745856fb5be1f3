#pragma once

#include <vector>

#include "bake/pipeline/cost_model.h"

namespace opaline::bake {

/// Fills in the plan's saved_seconds and saved_bytes: the extra cost of an entry's subject if the
/// entry were on, all else as planned, without the costs that all subjects share. predict_costs
/// must have filled in the plan before. One prediction for each rule that has an entry off.
void predict_savings(const CostRequest& request, std::vector<PlanEntry>& plan);

}  // namespace opaline::bake
