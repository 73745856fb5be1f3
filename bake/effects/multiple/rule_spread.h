#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// One rule: whether light spreads along the surface of a medium, or leaves where it entered
/// (README.md, "Bounds"). The bound is the sum of three errors of a half space lit like the vertex:
/// irradiance that varies over four mean edges and is blurred by the profile, light that passes
/// through the body, and facets tilted against the smooth surface.
std::span<const DecisionRule> spread_rules();

}  // namespace opaline::bake
