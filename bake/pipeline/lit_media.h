#pragma once

#include <span>
#include <vector>

#include "bake/emitters/light_media.h"
#include "bake/plan/bake_plan.h"
#include "bake/rows/subject_states.h"

namespace opaline::bake {

/// Whether any effect turns light that replaces the environment into rows of a material.
bool takes_other_light(const EffectTable& effects, std::span<const PlanEntry> decisions,
                       const RowLayout& layout);

/// The layout of a medium's rows of light that replaces the environment: as in the file, in three
/// bands.
RowLayout lit_layout(RowLayout layout);

/// What the media of a finished bake make of other light, by the effects of its plan: the answer
/// that emitters are baked with. `subjects`: studied; all arguments must outlive the result.
LightMedium make_light_medium(const BakeInputs& bake, std::span<const PlanEntry> plan,
                              const Knobs& knobs, const Context& context,
                              std::vector<SubjectState>& subjects);

}  // namespace opaline::bake
