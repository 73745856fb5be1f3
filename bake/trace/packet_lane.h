#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>

#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Gives a ray of a packet its unit direction and reach [m], and marks it to be traced.
inline void set_lane(RayPacket& packet, LaneMask& lanes, std::size_t lane, glm::vec3 direction,
                     float reach = std::numeric_limits<float>::infinity()) {
    packet.dir_x[lane] = direction.x;
    packet.dir_y[lane] = direction.y;
    packet.dir_z[lane] = direction.z;
    packet.tfar[lane] = reach;
    lanes[lane] = -1;
}

/// A place of its own for a ray of a packet.
inline void set_origin(RayPacket& packet, std::size_t lane, glm::vec3 origin) {
    packet.org_x[lane] = origin.x;
    packet.org_y[lane] = origin.y;
    packet.org_z[lane] = origin.z;
}

inline glm::vec3 direction_of(const RayPacket& packet, std::size_t lane) {
    return {packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]};
}

/// What one ray meets: lane 0.
inline PacketHits closest_of_one(const RayScene& scene, glm::vec3 from, glm::vec3 direction) {
    RayPacket packet = rays_from(from);
    LaneMask lanes{};
    set_lane(packet, lanes, 0, direction);
    return scene.closest(lanes, packet);
}

inline bool is_hidden(const RayScene& scene, glm::vec3 from, glm::vec3 direction, float reach) {
    RayPacket packet = rays_from(from);
    LaneMask lanes{};
    set_lane(packet, lanes, 0, direction, reach);
    scene.occluded(lanes, packet);
    return packet.tfar[0] < 0;
}

}  // namespace opaline::bake
