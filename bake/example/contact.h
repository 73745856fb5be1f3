#pragma once

#include "bake/example/field.h"
#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// Fits floor triangles to the curve where a solid meets the floor (y = 0). Vertices near the curve
/// move onto it; triangles that still lie on both sides are split along it. The contact shadow then
/// follows the curve without a zigzag, and no visible triangle has a corner inside the solid. The
/// curve followed is `gap` [mm] outside the solid.
void cut_at_contact(const Field& solid, double gap, TriangleMesh& floor);

}  // namespace opaline::bake
