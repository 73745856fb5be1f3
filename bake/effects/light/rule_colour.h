#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Whether a medium needs three bands. What is left out if it has one: the difference between its
/// bands. Coefficients are all that they can differ by: base colour, texture and veins multiply the
/// light that leaves, and stand in no row. So nothing is left out where the coefficients are
/// exactly equal; otherwise two bands, neither negative, differ at most by the larger, whose bound
/// is that of what is simulated of the medium.
PlanEntry decide_colour(const PlanInput& input);

}  // namespace opaline::bake
