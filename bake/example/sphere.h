#pragma once

#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// A ball from an icosahedron whose triangles are cut into four `levels` times:
/// 10 * 4^levels + 2 vertices.
TriangleMesh make_sphere(glm::dvec3 centre, double radius, unsigned levels);

}  // namespace opaline::bake
