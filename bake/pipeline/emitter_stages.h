#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bake/effects/rows/subject_states.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/pipeline/costed_bake.h"
#include "bake/pipeline/pipeline.h"
#include "bake/plan/bake_inputs.h"

namespace opaline::bake {

/// Adds the light of lamps, at least one, to a file whose rows of the environment are there, and
/// measures its error: as that of the effect "emitters" in `error`, and "emitters in media". Warns
/// of what it does not light. `surfaces`: what surfaces send to each other, or null where none of
/// the sky's light is followed; then it is found here. `subjects`: of the bake, studied. Errors:
/// interrupted, resource.
formats::Status add_lamp_rows(const BakeInputs& bake, std::span<const Lamp> lamps,
                              std::shared_ptr<const BounceLight> surfaces, const Context& context,
                              std::vector<SubjectState>& subjects, BakeResult& result);

/// The stages of add_lamp_rows in order.
void bill_lamps(const CostedBake& bake, std::span<PlanEntry> plan, Bill& bill);

}  // namespace opaline::bake
