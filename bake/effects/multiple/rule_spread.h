#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

inline constexpr std::string_view kSpreadName = "multiple.spread";

/// Decides whether light spreads along the surface of a medium, or leaves where it entered
/// (README.md, "Bounds"). The bound is the sum of three errors of a half space lit like the vertex:
/// irradiance that varies over four mean edges and is blurred by the profile, light that passes
/// through the body, and facets tilted against the smooth surface.
PlanEntry decide_spread(const PlanInput& input);

}  // namespace opaline::bake
