#pragma once

#include <glm/glm.hpp>

#include "bake/effects/multiple/walks/walk_space.h"

namespace opaline::bake {

/// Distance [m] to the nearest triangle, or `reach` [m] if that is less; smaller by a bound on
/// rounding. Triangles without an area do not count.
float find_clearance(const WalkSpace& space, glm::vec3 position, float reach);

}  // namespace opaline::bake
