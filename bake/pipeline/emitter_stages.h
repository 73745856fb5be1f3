#pragma once

#include <span>

#include "bake/emitters/lamps.h"
#include "bake/pipeline/bill.h"
#include "bake/pipeline/pipeline.h"
#include "bake/plan/bake_inputs.h"

namespace opaline::bake {

/// Adds the light of lamps, at least one, to a file whose rows of the environment are there, and
/// measures its error: as that of the effect "emitters" in `error`. Warns of what it does not
/// light. Errors: interrupted.
formats::Status add_lamp_rows(const BakeInputs& bake, std::span<const Lamp> lamps,
                              const Context& context, BakeResult& result);

/// The stages of add_lamp_rows in order. `plan`: with the entries of plan_emitters for the same
/// scene.
void bill_lamps(const CostRequest& request, std::span<PlanEntry> plan, Bill& bill);

}  // namespace opaline::bake
