#include "bake/refine/edge_cut.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "bake/receivers/vertex_receivers.h"

namespace opaline::bake {
namespace {

// Where the plane of a triangle cuts the line, as a share of the way. By the corners in double
// precision: what rounding leaves lies in the plane, so that rays start in front of it.
double share_at(const formats::Primitive& p, std::uint32_t first_index, glm::dvec3 from,
                glm::dvec3 way) {
    const glm::dvec3 a = p.position[p.index[first_index]];
    const glm::dvec3 b = p.position[p.index[first_index + 1]];
    const glm::dvec3 c = p.position[p.index[first_index + 2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    return glm::dot(normal, a - from) / glm::dot(normal, way);
}

}  // namespace

EdgeCut find_edge_cut(const formats::Scene& scene, const RayScene& rays, glm::vec3 from,
                      glm::vec3 to, std::span<const glm::vec3> normals, double shortest) {
    const glm::vec3 way = to - from, middle = 0.5f * from + 0.5f * to;
    const float length = glm::length(way);
    if (rays.is_empty() || !(static_cast<double>(length) > 2 * shortest)) return {};
    const glm::vec3 half = glm::abs(0.5f * way);
    const float lift = 4 * clearance_bound(middle, std::max({half.x, half.y, half.z}));
    // From the middle to both ends, for each normal.
    RayPacket packet = rays_from(middle);
    LaneMask lanes{};
    const std::size_t used = 2 * std::min(normals.size(), std::size_t{RayPacket::kSize / 2});
    for (std::size_t lane = 0; lane < used; ++lane) {
        const glm::vec3 origin = middle + lift * normals[lane / 2];
        const glm::vec3 direction = (lane % 2 == 0 ? 1.0f : -1.0f) * way / length;
        packet.org_x[lane] = origin.x, packet.dir_x[lane] = direction.x;
        packet.org_y[lane] = origin.y, packet.dir_y[lane] = direction.y;
        packet.org_z[lane] = origin.z, packet.dir_z[lane] = direction.z;
        packet.tfar[lane] = 0.5f * length;
        lanes[lane] = -1;
    }
    const PacketHits hits = rays.closest(lanes, packet);
    EdgeCut best;
    double nearest = 0.5 - shortest / static_cast<double>(length);
    for (std::size_t lane = 0; lane < used; ++lane) {
        if (hits.hit[lane] == 0) continue;
        const double share =
            share_at(scene.primitives[hits.primitive[lane]], hits.first_index[lane],
                     glm::dvec3(from) - glm::dvec3(hits.offset[lane]), glm::dvec3(way));
        if (!(std::abs(share - 0.5) < nearest)) continue;
        nearest = std::abs(share - 0.5);
        const bool forth = lane % 2 == 0, leaves = hits.cosine[lane] > 0;
        best = {share, forth == leaves ? 1.0f : -1.0f};
    }
    return best;
}

}  // namespace opaline::bake
