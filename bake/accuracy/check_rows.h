#pragma once

#include <span>
#include <vector>

#include "bake/accuracy/measure_error.h"
#include "bake/rows/subject_states.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// How far finished rows are from the truth at held-back receivers, without base colour: each
/// subject's rows as a whole, seen along the normal, under the lights as they are. Effects whose
/// truth is expensive are checked at some 256 receivers of all.
std::vector<EffectCheck> check_rows(const BakeInputs& bake, std::span<const SubjectState> subjects,
                                    const Knobs& knobs, const formats::AssetView& asset,
                                    std::span<const TestLight> lights, const Context& context);

}  // namespace opaline::bake
