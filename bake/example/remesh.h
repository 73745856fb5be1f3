#pragma once

#include "bake/example/field.h"
#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

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
void remesh(const Field& field, const RemeshOptions& options, TriangleMesh& mesh);

}  // namespace opaline::bake
