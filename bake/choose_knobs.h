#pragma once

#include <vector>

#include "bake/base/context.h"
#include "bake/measure/test_lights.h"
#include "bake/pilot/pilot.h"
#include "bake/pipeline.h"

namespace opaline::bake {

/// Changes those of result.knobs that the user did not fix into the cheapest that meet their
/// error_target, as far as the pilot can tell, and prepares the media with them. Fills in
/// result.accuracy. `lights` are left with the cube map that was chosen.
MediaStages choose_knobs(const PilotScene& pilot, std::vector<TestLight>& lights,
                         const Context& context, BakeResult& result);

/// Says where result.accuracy was not reached.
void warn_of_missed_target(const BakeResult& result, std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
