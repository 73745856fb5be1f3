#pragma once

#include <glm/glm.hpp>
#include <span>

#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Where an edge is cut in two.
struct EdgeCut {
    double share = 0.5;  ///< of the way from its first end to its second, in (0, 1)
    /// Where a surface crosses: -1, the way to the first end lies in front of it; 1, that to the
    /// second end does. 0: nothing crosses here.
    float front = 0;

    /// Of the same edge from its second end to its first.
    EdgeCut turned() const { return {1 - share, -front}; }
};

/// Cuts an edge where another surface crosses it, nearest to its middle and at least `shortest` [m]
/// from both ends: a floor that runs on below a wall sees another world there, and no row between
/// its ends stands for both. The middle where none does.
///
/// Rays run in front of the triangles that share the edge, so they meet what stands on them, too.
/// `from`, `to` [m]; `normals`: unit, of those triangles, of which the first eight count.
EdgeCut find_edge_cut(const formats::Scene& scene, const RayScene& rays, glm::vec3 from,
                      glm::vec3 to, std::span<const glm::vec3> normals, double shortest);

}  // namespace opaline::bake
