#pragma once

#include "bake/example/field.h"
#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// The surface of a solid as a closed 2-manifold mesh with shared vertices: marching cubes
/// [Lorensen1987], with the outline in each cell traced over its faces in place of a case table, so
/// that neighbouring cells always agree. Triangles face outward. They may be slivers, and their
/// vertices lie near the surface, not on it; `remesh` repairs both. Normals stay empty. `cell`
/// [mm]: edge of a grid cell, below the thinnest wall and gap of the solid. Precondition: the
/// surface keeps a cell's distance from the sides of `bounds`.
TriangleMesh polygonize(const Field& field, const Box& bounds, double cell);

}  // namespace opaline::bake
