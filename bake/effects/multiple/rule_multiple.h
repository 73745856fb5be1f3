#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Light that scatters several times in a medium. The bound is the smaller of twice the reflectance
/// of a half space by diffusion, and small_body_bound (README.md, "Bounds"). The first bounds the
/// model: the light that truly crosses a thin body with a forward phase function may be more.
PlanEntry decide_multiple(const PlanInput& input);

/// Bound on the radiance of a body in one band after two or more scattering events, under radiance
/// of at most 1; also a bound on the result of diffusion. `diagonal` [m] of the body's bounding
/// box, `area` [m^2] of its surface. Infinity if eta is not 1: with internal reflection, light may
/// travel any distance in a small body.
///
/// A line of length d through the body gains by scattering at most the share alpha (1 - e^(-sigma_t
/// d)) of the light at its points. The part of that light that scattered before is at most such a
/// share again. Diffusion sums R_d over the surface, so it is at most R_d(0) A, because R_d is
/// largest at its centre. Where R_d is scaled to a walk's energy, the walk returns at most alpha^2.
double small_body_bound(const formats::Medium& medium, const Band& band, double diagonal,
                        double area);

}  // namespace opaline::bake
