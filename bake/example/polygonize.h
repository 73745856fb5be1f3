#pragma once

#include "bake/example/field.h"
#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// The surface of a solid as a closed mesh with shared vertices, by naive surface nets: one vertex
/// in each grid cell that the surface crosses, one quad around each grid edge that it crosses.
/// [Gibson 1998, Constrained elastic surface nets]. Normals are left empty; vertices lie near the
/// surface, not on it: `remesh` moves them there.
/// `cell` [mm]: edge of a grid cell, below the thinnest wall and gap of the solid.
/// Precondition: the surface keeps a cell's distance from the sides of `bounds`.
TriangleMesh polygonize(const Field& field, const Box& bounds, double cell);

}  // namespace opaline::bake
