#pragma once

#include <vector>

#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

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
