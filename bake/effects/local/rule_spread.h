#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Whether light is carried across the surface of a medium, or leaves where it entered
/// (translucency.md 9, opaque limit). The bound is the sum of what a half space, lit as the vertex
/// is, has wrong: irradiance that varies over four mean edges and is blurred by the profile, light
/// that gets through the body, and facets that lean away from the smooth surface.
PlanEntry decide_spread(const PlanInput& input);

}  // namespace opaline::bake
