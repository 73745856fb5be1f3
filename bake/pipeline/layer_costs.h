#pragma once

#include <span>

#include "bake/pipeline/bill.h"
#include "bake/pipeline/cost_model.h"

namespace opaline::bake {

/// The stages of add_layers in order. `plan`: with the entries of plan_layers for the same scene,
/// which decide what is baked and pay for it. Without them everything is baked, and shared.
void bill_layers(const CostRequest& request, std::span<PlanEntry> plan, Bill& bill);

}  // namespace opaline::bake
