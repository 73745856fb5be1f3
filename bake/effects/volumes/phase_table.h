#pragma once

#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// p' of a phase function p without its forward peak, exactly: min(p, cut) / (1 - peak), with the
/// cut at which the integral of min(p, cut) over the sphere is 1 - peak. Where `peak` is 0 it is p
/// itself. kPhaseEntries values [1/sr] as formats/opal/ball_bank.h evaluates them, not negative,
/// with an integral of 1 to the rounding of floats. An entry is the mean over the steps around it:
/// peaks narrower than a step keep their light. Error at other cosines, Henyey-Greenstein: below
/// 0.6 % for |g| <= 0.85 without a peak; with it 1.6 % at the edge of the cut for g = 0.85, 2.6 %
/// for 0.95. `peak`: ScaledPhase::peak, in [0, 1). Precondition: the phase function is within the
/// bounds of formats/scene.h.
std::vector<float> tabulate_phase(const formats::PhaseFunction& phase, double peak);

}  // namespace opaline::bake
