#pragma once

#include <span>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/effects/rows/gather_rows.h"
#include "bake/effects/rows/subject_states.h"
#include "bake/plan/bake_inputs.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// The rows of all receivers, in their order, complete and quantised; one stage of the report for
/// each set. `volumes`: that stand before them; may be null. `measures_errors`: fills
/// GatheredRows::receiver_error. What is missing where the context was cancelled is missing at the
/// end. Errors: resource (more coefficients than a file holds), a row that is not finite.
formats::Result<GatheredRows> bake_rows(const BakeInputs& bake, const VolumesBefore* volumes,
                                        std::span<const SubjectState> subjects, const Knobs& knobs,
                                        bool measures_errors, const Context& context,
                                        StageLog& log);

/// Of all receivers; empty where nothing is glossy.
std::vector<formats::Openness> bake_all_openness(const BakeInputs& bake,
                                                 std::span<const SubjectState> subjects,
                                                 const Context& context, StageLog& log);

}  // namespace opaline::bake
