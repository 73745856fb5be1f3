#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The path from a body point along its inward normal.
struct InwardPath {
    float length = 0;   ///< d_m [m] to where the medium ends; 0: the normal points out of the body
    bool open = false;  ///< no exit was found and `length` is the limit given
    bool nested = false;  ///< part of the path lies inside more than one shell of the medium
    /// Depths [m] at which the number of enclosing shells changes, ascending, with the number
    /// beyond.
    struct Step {
        float depth;
        std::int32_t shells;
    };
    std::vector<Step> steps;
};

/// Follows the inward normal by signed depth: a crossing from behind a triangle ends one shell of
/// the medium, a crossing from the front begins one. The number of shells at the start is such that
/// none remains at infinity. `limit`: length of an open path [m].
InwardPath trace_inward_path(const RayScene& rays, const BodyPoint& point, float limit);

/// Number of shells of the medium around the point at `depth` on the path.
std::int32_t shells_at(const InwardPath& path, float depth);

/// Diagonal [m] of the bounding box of each material's triangles, by material.
std::vector<float> body_diagonals(const formats::Scene& scene);

/// Entry points into the medium of light from sixteen directions on its way to sixteen interior
/// points.
struct PacketEntries {
    LaneMask lit;              ///< -1: light from that direction arrives, 0: it does not
    RayPacket::Lane distance;  ///< s_i [m], straight
    RayPacket::Lane cosine;    ///< n_i . w > 0
    RayPacket::Lane normal_x, normal_y, normal_z;  ///< n_i
};

/// Counters of a gather.
struct EntryCounts {
    std::uint64_t rays = 0;     ///< traced, of both kinds
    std::uint64_t missing = 0;  ///< directions without an exit: holes in the boundary
};

/// The exit of each ray in `lanes` by signed depth (effects/single/README.md, "Signed depth"), then
/// one any-hit query beyond it. Surfaces of other materials block anywhere. `packet`: origins
/// inside the medium; unit directions toward the light. `shells`: number of shells of the medium
/// around each origin, >= 1.
PacketEntries find_entries(const RayScene& rays, std::uint32_t material, LaneMask lanes,
                           RayPacket packet, std::array<std::int32_t, RayPacket::kSize> shells,
                           EntryCounts& counts);

}  // namespace opaline::bake
