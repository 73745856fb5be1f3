#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Light that scatters once in a medium, and the number of terms of its phase function (README.md,
/// "Bounds").
PlanEntry decide_single(const PlanInput& input);

/// True if the phase function is not isotropic.
bool is_anisotropic(const PlanInput& input);

/// The terms beyond the first, for a medium that is_anisotropic; with one term the rows do not
/// depend on the view. PlanEntry::terms is the number K of all terms, or 0 without single
/// scattering. The bound is the light scattered within the body times the RMS difference of the
/// phase function from its first term, 4 pi phase_rms(series, 1).
PlanEntry decide_terms(const PlanInput& input);

/// The smallest K whose error, times the share of single scattering, is at most
/// `knobs.phase_tolerance`.
std::uint32_t needed_terms(const formats::Medium& medium, const Knobs& knobs);

/// The same, unless the user gave K.
std::uint32_t choose_terms(const formats::Medium& medium, const Knobs& knobs);

}  // namespace opaline::bake
