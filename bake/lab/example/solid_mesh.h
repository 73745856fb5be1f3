#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>

#include "bake/lab/example/triangle_mesh.h"

namespace opaline::bake {

/// An implicit solid: negative inside, zero on the surface, positive outside, close to the signed
/// distance [mm] near the surface. Called from several threads at once.
using ScalarField = std::function<double(const glm::dvec3&)>;

/// Axis-aligned box, low <= high in each axis.
struct Box {
    glm::dvec3 low{0.0}, high{0.0};
};

/// Union of two solids whose seam is filleted over `width` [mm] > 0. Twice differentiable, so that
/// highlights run smoothly over the seam; exactly min(a, b) where |a - b| >= width.
inline double smooth_union(double a, double b, double width) {
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - h * h * h * width / 6.0;
}

/// Intersection filleted in the same way.
inline double smooth_intersection(double a, double b, double width) {
    return -smooth_union(-a, -b, width);
}

/// Ellipsoid about the origin; exact to first order at its surface. Every radius > 0.
inline double ellipsoid(const glm::dvec3& p, const glm::dvec3& radii) {
    const double scaled = glm::length(p / radii);
    const double slope = glm::length(p / (radii * radii));
    return slope > 1e-12 ? scaled * (scaled - 1.0) / slope : -std::min({radii.x, radii.y, radii.z});
}

/// Direction of steepest increase of the field, not normalised, by differences over `step` [mm].
inline glm::dvec3 gradient(const ScalarField& field, const glm::dvec3& p, double step) {
    // Four samples at the corners of a tetrahedron: as accurate to first order as six on the axes.
    constexpr glm::dvec3 kCorners[] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& corner : kCorners) {
        sum += corner * field(p + step * corner);
    }
    return sum / (4.0 * step);
}

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
