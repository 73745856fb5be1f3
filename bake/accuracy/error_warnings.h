#pragma once

#include <vector>

#include "bake/accuracy/measure_error.h"
#include "bake/plan/knobs.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The largest measured error that goes without a warning where no error was asked for: 20 % of
/// drafts, 10 % of everything finer.
double acceptable_error(Quality quality);

/// Whether neither receivers nor what lies between them err by more than Knobs::error_target.
bool meets_target(const ErrorReport& error, const Knobs& knobs);

/// Says where the self-check found too much, and what to change. With Knobs::error_target: between
/// receivers alone, more than the target; what it found at receivers is for the pilot to explain.
/// Without: wherever the lower end of the interval is above acceptable_error.
std::vector<formats::Diagnostic> describe_measured_error(const formats::Scene& scene,
                                                         const Knobs& knobs,
                                                         const ErrorReport& error);

}  // namespace opaline::bake
