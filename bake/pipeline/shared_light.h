#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/effects/rows/subject_states.h"
#include "bake/exchange/other_light.h"

namespace opaline::bake {

/// What light of surfaces is found from. The subjects have been studied; they are left without
/// samples.
struct LightRequest {
    const BakeInputs& bake;  ///< without BakeInputs::light
    const Knobs& knobs;
    const Context& context;
    std::span<const RowLayout> layouts;  ///< by material, with their tints
    std::vector<SubjectState>& subjects;
    std::span<const Receiver> onlookers;  ///< LightInputs::onlookers
    StageLog& log;
};

/// Light that surfaces send to each other, or none if no acting effect has it do so.
std::optional<OtherLight> find_shared_light(const LightRequest& request);

/// What surfaces make of the sky's light, where they send none to each other; null where nobody
/// sees one.
std::shared_ptr<const BounceLight> find_surface_light(const LightRequest& request);

/// What light of lamps goes between surfaces by, where that of the sky is not followed; null where
/// nobody sees one.
std::shared_ptr<const BounceLight> find_light_for_lamps(const LightRequest& request);

/// A warning where bounces still were a hundredth of the light when the solve ended, as in closed
/// rooms that hardly absorb: what follows is extrapolated.
std::optional<formats::Diagnostic> describe_unsettled(const OtherLight& light);

}  // namespace opaline::bake
