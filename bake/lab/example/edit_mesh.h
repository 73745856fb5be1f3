#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/lab/example/triangle_mesh.h"

namespace opaline::bake {

/// An undirected edge of a closed mesh and its two triangles.
struct Edge {
    std::uint32_t a = 0, b = 0;         ///< vertices; triangle `left` holds the directed edge a b
    std::uint32_t left = 0, right = 0;  ///< triangles
};

/// Every edge of a mesh once, ordered by its smaller, then its larger vertex. Edges that are not
/// shared by exactly two triangles of opposite direction are left out.
std::vector<Edge> find_edges(const TriangleMesh& mesh);

/// Triangles around each vertex: vertex v has triangle[begin[v]] ... [begin[v + 1]).
struct VertexTriangles {
    std::vector<std::size_t> begin;
    std::vector<std::uint32_t> triangle;
};
VertexTriangles find_vertex_triangles(const TriangleMesh& mesh);

/// The corner of a triangle that is neither a nor b. Precondition: a and b are two of its corners.
inline std::uint32_t opposite_vertex(const Triangle& triangle, std::uint32_t a, std::uint32_t b) {
    return *std::find_if(triangle.begin(), triangle.end(),
                         [&](std::uint32_t v) { return v != a && v != b; });
}

/// Twice the area times the unit normal of a triangle.
inline glm::dvec3 area_vector(const TriangleMesh& mesh, const Triangle& t) {
    const glm::dvec3 &a = mesh.position[t[0]], &b = mesh.position[t[1]], &c = mesh.position[t[2]];
    return glm::cross(b - a, c - a);
}

// Edits of a closed mesh that keep it closed, manifold and of the same genus. `target` holds the
// wanted edge length [mm] at each vertex and is kept in step with the vertices; positions and
// normals of new vertices are means of old ones.

/// Halves edges longer than 4/3 of their target, longest first within what one pass can reach.
void split_long_edges(TriangleMesh& mesh, std::vector<double>& target);

/// Collapses edges shorter than 4/5 of their target, where no triangle folds over.
void collapse_short_edges(TriangleMesh& mesh, std::vector<double>& target);

/// Flips edges whose opposite angles sum to more than 180 degrees, where the surface is nearly flat
/// across them.
void flip_to_delaunay(TriangleMesh& mesh);

}  // namespace opaline::bake
