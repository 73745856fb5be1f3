#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/check/measure_error.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/effect.h"
#include "bake/plan/knobs.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// 0.123 as "12.3 %", three digits.
std::string error_percent(double share);

/// The largest measured error that goes without a warning where no error was asked for: 20 % of
/// drafts, 10 % of everything finer.
double acceptable_error(Quality quality);

/// Whether the error at receivers and the error between them, the models' included, are at most
/// Knobs::error_target.
bool meets_target(const ErrorReport& error, const Knobs& knobs);

/// Warnings where the self-check found too large an error, with a remedy. With Knobs::error_target:
/// between receivers alone, above Knobs::numerical_target(); the pilot explains errors at
/// receivers. Without: wherever the lower end of the interval is above acceptable_error.
/// `refinement_is_bounded`: a limit of receivers ended refinement, so that a larger one helps.
std::vector<formats::Diagnostic> describe_measured_error(const formats::Scene& scene,
                                                         const Knobs& knobs,
                                                         const ErrorReport& error,
                                                         bool refinement_is_bounded);

/// Names of the effects that the bake simulates and the self-check does not see, each once, in the
/// order of the plan: those that add nothing to rows, because the runtime computes them for an eye.
std::vector<std::string_view> unmeasured_effects(const EffectTable& effects,
                                                 std::span<const PlanEntry> plan);

}  // namespace opaline::bake
