#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/exchange/other_light.h"
#include "bake/rows/subject_states.h"

namespace opaline::bake {

/// Light that surfaces send to each other, or none if no acting effect has it do so. `bake`:
/// without it. `layouts`: by material, with their tints. The subjects have been studied; they are
/// left without samples.
std::optional<OtherLight> find_shared_light(const BakeInputs& bake, const Knobs& knobs,
                                            const Context& context,
                                            std::span<const RowLayout> layouts,
                                            std::vector<SubjectState>& subjects, StageLog& log);

}  // namespace opaline::bake
