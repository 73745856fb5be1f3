#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/single/path_quadrature.h"
#include "bake/visibility/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A point on the boundary of a translucent body, seen from inside.
struct BodyPoint {
    glm::vec3 position;          ///< [m]
    glm::vec3 normal;            ///< unit, outward; {0,0,0}: nothing is gathered
    glm::vec3 inner;             ///< [m], just inside all triangles that meet at the point
    std::uint32_t material = 0;  ///< whose triangles bound the body
};

/// Body points of all vertices, in output order, from their receivers (make_vertex_receivers): a
/// receiver starts in front of its triangles, its mirror image in the vertex behind them. Vertices
/// of opaque materials get no normal.
std::vector<BodyPoint> make_body_points(const formats::Scene& scene,
                                        std::span<const Receiver> receivers);

/// The way from a body point along its inward normal.
struct InwardPath {
    float length = 0;   ///< d_m [m] to where the medium ends; 0: the normal points out of the body
    bool open = false;  ///< no exit was found and `length` is the limit given
    bool nested = false;  ///< somewhere on the way more than one shell of the medium is around
    /// Where the number of shells around changes [m], ascending, and what it is from there on.
    struct Step {
        float depth;
        std::int32_t shells;
    };
    std::vector<Step> steps;
};

/// Follows the inward normal by signed depth: leaving a triangle through its back ends one shell
/// of the medium, entering one through its front begins one. How many shells are around at the
/// start is what makes none remain at infinity. `limit`: where an open path is cut [m].
InwardPath trace_inward_path(const RayScene& rays, const BodyPoint& point, float limit);

/// How many shells of the medium are around the point at `depth` on the path.
std::int32_t shells_at(const InwardPath& path, float depth);

/// Diagonal [m] of the bounding box of each material's triangles, by material.
std::vector<float> body_diagonals(const formats::Scene& scene);

/// Where light from sixteen directions enters the medium on its way to sixteen interior points.
struct PacketEntries {
    LaneMask lit;              ///< -1: reached by light from that direction, 0: not
    RayPacket::Lane distance;  ///< s_i [m], straight
    RayPacket::Lane cosine;    ///< n_i . w > 0
    RayPacket::Lane normal_x, normal_y, normal_z;  ///< n_i
};

/// Counters of a gather.
struct EntryCounts {
    std::uint64_t rays = 0;     ///< traced, of both kinds
    std::uint64_t missing = 0;  ///< directions that left the body nowhere: holes in its boundary
};

/// The exit of each ray in `lanes` by signed depth (README.md, "Signed depth"), then
/// one query beyond it against everything. What is not of `material` blocks wherever it is met.
/// `packet`: origins inside the medium, relative to the scene's centre; unit directions toward the
/// light. `shells`: how many shells of the medium are around each origin, >= 1.
PacketEntries find_entries(const RayScene& rays, std::uint32_t material, LaneMask lanes,
                           RayPacket packet, std::array<std::int32_t, RayPacket::kSize> shells,
                           EntryCounts& counts);

}  // namespace opaline::bake
