#pragma once

#include "bake/lab/example/field.h"
#include "bake/lab/example/triangle_mesh.h"

namespace opaline::bake {

/// The surface of a solid as a closed 2-manifold mesh with shared vertices: marching cubes
/// [Lorensen1987], with the outline in each cell traced over its faces in place of a case table, so
/// that neighbouring cells always agree. Triangles face outward. They may be slivers, and their
/// vertices lie near the surface, not on it; `remesh` repairs both. Normals stay empty. `cell`
/// [mm]: edge of a grid cell, below the thinnest wall and gap of the solid. Precondition: the
/// surface keeps a cell's distance from the sides of `bounds`.
TriangleMesh polygonize(const ScalarField& field, const Box& bounds, double cell);

/// Resolution of a remeshed surface.
struct RemeshOptions {
    double shortest = 0.6;    ///< target edge where the surface bends most [mm]
    double longest = 1.6;     ///< target edge where it is flat [mm]
    double deviation = 0.03;  ///< wanted distance between a triangle and the surface [mm]
    int rounds = 6;
};

/// Turns a rough closed mesh of a solid's surface into one of nearly equilateral triangles whose
/// vertices lie on the surface and whose size follows its curvature; fills in the normals from the
/// field's gradient. Rounds of splitting long edges, collapsing short ones, flipping to Delaunay
/// and relaxing along the surface, after [Botsch2004]. Keeps the mesh closed, manifold
/// and of the same genus.
/// Same result for any number of threads.
void remesh(const ScalarField& field, const RemeshOptions& options, TriangleMesh& mesh);

/// Fits floor triangles to the curve where a solid meets the floor (y = 0). Vertices near the curve
/// move onto it; triangles that still lie on both sides are split along it. The contact shadow then
/// follows the curve without a zigzag, and no visible triangle has a corner inside the solid. The
/// curve followed is `gap` [mm] outside the solid.
void cut_at_contact(const ScalarField& solid, double gap, TriangleMesh& floor);

}  // namespace opaline::bake
