#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Light that scatters once in a medium, and how many terms of its phase function that takes
/// (translucency.md 9).
PlanEntry decide_single(const PlanInput& input);

/// Whether a medium scatters into some directions more than into others.
bool is_anisotropic(const PlanInput& input);

/// The terms beyond the first, of a medium that is_anisotropic: with one alone the rows do not
/// depend on the view. PlanEntry::terms is the number K of all; 0 where nothing scatters once.
/// The bound: light that scatters within the body, times the mean difference of the phase function
/// and its first term, which is at most the root of the mean square: 4 pi phase_rms(series, 1).
PlanEntry decide_terms(const PlanInput& input);

/// The share of single scattering in what a half space returns of uniform light: the largest over
/// the bands. In [0, 1].
double single_share(const formats::Medium& medium);

/// The smallest K whose error, times the share of single scattering, is at most
/// `knobs.phase_tolerance` (translucency.md 9).
std::uint32_t needed_terms(const formats::Medium& medium, const Knobs& knobs);

/// The same, unless the user gave one.
std::uint32_t choose_terms(const formats::Medium& medium, const Knobs& knobs);

}  // namespace opaline::bake
