#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/exchange/other_light.h"
#include "bake/rows/subject_states.h"

namespace opaline::bake {

/// Light that an effect sends to all surfaces, or null if no acting effect does. `bake`: without
/// it. `layouts`: by material, with their tints. The subjects have been studied; they are left
/// without samples.
///
/// Media are evaluated at the knobs of the preset `draft` and the smallest cube map, because their
/// light is smooth where it arrives.
std::unique_ptr<OtherLight> find_shared_light(const BakeInputs& bake, const Knobs& knobs,
                                              const Context& context,
                                              std::span<const RowLayout> layouts,
                                              std::vector<SubjectState>& subjects, StageLog& log);

}  // namespace opaline::bake
