#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Whether anything may stand between a material's receivers and the light. Where nothing does, all
/// light above a receiver's horizon arrives and no ray need be traced to know it. Of a uniform
/// light of radiance 1, what surfaces no higher than an elevation e can take away is at most
///     1/pi int_(elevation < e) (n.w) dw = sin^2 e;
/// from points on a facet of a convex body, whose shading normal n leans away from the facet's n_f,
/// the facet takes away
///     1/pi int_(n.w > 0, n_f.w < 0) (n.w) dw = (1 - n.n_f) / 2.
PlanEntry decide_visibility(const PlanInput& input);

}  // namespace opaline::bake
