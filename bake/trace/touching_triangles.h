#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/embree_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

struct TouchingTriangle {
    std::uint32_t primitive = 0, triangle = 0;
    bool is_corner = false;  ///< the point is a corner of the triangle
    glm::vec3 normal{0};     ///< unit
    float extent = 0;        ///< [m], largest coordinate difference from the point to a corner
};

/// Triangles with an area that have the point as a corner or come within `radius` [m] of it, in the
/// scene's order. None where there are more than 128: that is no clean mesh, and bounds the work.
std::vector<TouchingTriangle> find_touching_triangles(const EmbreeScene& triangles,
                                                      const formats::Scene& scene,
                                                      glm::vec3 position, float radius);

/// A vertex may lie on triangles of which it is no corner: where a long edge meets the short edges
/// of a finer grid, and where a wall stands on a floor. make_vertex_receivers knows nothing of
/// these; rays that start in their plane miss or hit them by rounding. This moves the origin of
/// such a receiver in front of all triangles that touch the vertex, as make_vertex_receivers does
/// for those that meet there. Receivers that no further triangle touches stay as they are, bit by
/// bit, and so do those for which no direction is in front of all: see contacts.h.
/// `position`: of the vertex [m].
Receiver leave_touching_triangles(const EmbreeScene& triangles, const formats::Scene& scene,
                                  glm::vec3 position, Receiver receiver);

/// The same for one receiver per vertex of the scene, in output order.
std::vector<Receiver> leave_touching_triangles(const EmbreeScene& triangles,
                                               const formats::Scene& scene,
                                               std::vector<Receiver> receivers,
                                               const Context& context);

}  // namespace opaline::bake
