#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Light that scatters several times in a medium. The bound is what diffusion makes of a half space
/// on both sides (translucency.md 9), or what a body so small can send out, see small_body_bound.
/// The first is one of the model: what really crosses a thin body of a forward phase function may
/// be more, whether diffusion is simulated or not.
PlanEntry decide_multiple(const PlanInput& input);

/// Bound on the radiance that a body of one band sends out after two scatterings or more, where
/// nothing outside of it is brighter than 1; and on what diffusion makes of it. `diagonal` [m] of
/// the body's bounds, `area` [m^2] of its surface. Infinity where there is none: behind a boundary
/// that reflects inside (eta is not 1), light may travel any distance in a body however small.
///
/// Light that a line through the body, of length d at most, picks up by scattering is a share
/// alpha (1 - e^(-sigma_t d)) of what arrives at its points; what of that has scattered before is
/// such a share of another line's light, which is at most 1. Diffusion sums R_d, which is largest
/// at its centre, over the surface: at most R_d(0) A; where R_d is scaled to the energy of a walk,
/// as if that were alpha^2, what survives two scatterings.
double small_body_bound(const formats::Medium& medium, const Band& band, double diagonal,
                        double area);

}  // namespace opaline::bake
