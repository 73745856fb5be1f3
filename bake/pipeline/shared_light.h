#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/exchange/bounce_light.h"
#include "bake/rows/subject_states.h"

namespace opaline::bake {

/// The knobs of media there: KnobSpec::coarse, or those of the coarsest preset, with the choices of
/// `knobs`.
Knobs coarse_knobs(const EffectTable& effects, const Knobs& knobs, std::uint32_t cubemap_size);

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

/// Light that an effect sends to all surfaces, or null if no acting effect does.
///
/// Media are evaluated at the knobs of the preset `draft` and the smallest cube map, because their
/// light is smooth where it arrives.
std::unique_ptr<OtherLight> find_shared_light(const LightRequest& request);

/// What surfaces make of the sky's light, where they send none to each other; null where nobody
/// sees one.
std::shared_ptr<const BounceLight> find_surface_light(const LightRequest& request);

}  // namespace opaline::bake
