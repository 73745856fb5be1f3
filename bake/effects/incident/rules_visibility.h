#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Decides whether anything may occlude the light of a material's receivers. If nothing does, all
/// light above the horizon arrives and no ray is traced. Surfaces up to an elevation e block at
/// most this share of uniform light:
///     1/pi int_(elevation < e) (n.w) dw = sin^2 e;
/// At a point of a convex body whose shading normal n is tilted against the facet's normal n_f, the
/// facet blocks
///     1/pi int_(n.w > 0, n_f.w < 0) (n.w) dw = (1 - n.n_f) / 2.
PlanEntry decide_visibility(const PlanInput& input);

}  // namespace opaline::bake
