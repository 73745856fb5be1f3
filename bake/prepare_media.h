#pragma once

#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/measure/test_lights.h"
#include "bake/pilot/pilot.h"
#include "bake/pipeline.h"

namespace opaline::bake {

/// Of the media whose multiple scattering is simulated.
MediaProfiles make_profiles(const formats::Scene& scene, std::span<const RowLayout> layouts,
                            std::uint64_t seed, const Context& context);

/// What enters each medium; none of the knobs of its rows matters to it. Notes its stages in
/// `result`.
MediaStages prepare_media(const PilotScene& pilot, const Knobs& knobs, const Context& context,
                          BakeResult& result);

/// Changes those of result.knobs that the user did not fix into the cheapest that meet their
/// error_target, as far as the pilot can tell, and prepares the media with them. Fills in
/// result.accuracy. `lights` are left with the cube map that was chosen.
MediaStages choose_knobs(const PilotScene& pilot, std::vector<TestLight>& lights,
                         const Context& context, BakeResult& result);

/// What is left to prepare once every knob has its value.
void finish_media(const PilotScene& pilot, const Knobs& knobs, const Context& context,
                  BakeResult& result, MediaStages& media);

/// Says where result.accuracy was not reached.
void warn_of_missed_target(const BakeResult& result, std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
