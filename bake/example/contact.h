#pragma once

#include "bake/example/field.h"
#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// Moves floor vertices onto the curve where a solid meets the floor (y = 0): of every edge that
/// crosses it, the nearer end. Each triangle then lies on one side, and the shadow that begins at
/// the curve is interpolated along it instead of in a zigzag across it. Vertices are moved by less
/// than half an edge and end up `gap` [mm] outside the solid; a move that would turn a triangle
/// over is left out.
void snap_to_contact(const Field& solid, double gap, TriangleMesh& floor);

}  // namespace opaline::bake
