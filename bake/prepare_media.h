#pragma once

#include <span>
#include <vector>

#include "bake/base/context.h"
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

/// What is left to prepare once every knob has its value.
void finish_media(const PilotScene& pilot, const Knobs& knobs, const Context& context,
                  BakeResult& result, MediaStages& media);

}  // namespace opaline::bake
