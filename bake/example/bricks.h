#pragma once

#include <vector>

#include "bake/example/triangle_mesh.h"
#include "formats/image/image.h"

namespace opaline::bake {

/// Smooth meshes whose relief is in a normal map. Lengths in millimetres.

/// A mesh with texture coordinates, one a vertex; v = 0 on top of the image.
struct MappedMesh {
    TriangleMesh mesh;
    std::vector<glm::dvec2> texcoord;
};

/// Parallelogram corner + s a + t b, s and t in [0, 1], cut into cells x cells squares; its front
/// has the normal of cross(a, b). The image repeats every `tile` along both, upright along b.
MappedMesh make_panel(glm::dvec3 corner, glm::dvec3 a, glm::dvec3 b, unsigned cells, double tile);

/// A ball by longitude and latitude; the image goes around it four times and from pole to pole
/// twice.
MappedMesh make_mapped_ball(glm::dvec3 centre, double radius);

/// Normals of four courses of bricks, two by four to a tile, rough on their faces: red toward
/// growing u, green upward, code 128 is 0. The image repeats.
formats::Image8 paint_brick_normals();

}  // namespace opaline::bake
