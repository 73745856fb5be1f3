#include "bake/trace/body.h"

#include <algorithm>
#include <limits>

namespace opaline::bake {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// More crossings than any body has; bounds the work that a hostile mesh can ask for.
constexpr int kMostCrossings = 256;

// Distance at which the next query starts: beyond the hit's duplicate in a neighbouring triangle,
// which differs by rounding only. The position of a grazing hit along the ray is less certain.
float step_behind(const PacketHits& hits, std::uint32_t lane) {
    constexpr float kGrazing = 0.02f;
    const float distance = hits.distance[lane];
    const float bound = hits.error[lane] / std::max(std::abs(hits.cosine[lane]), kGrazing);
    return distance + std::max(bound, 1e-6f * distance);
}

RayPacket one_ray(glm::vec3 origin, glm::vec3 direction) {
    RayPacket packet{};
    packet.org_x[0] = origin.x, packet.org_y[0] = origin.y, packet.org_z[0] = origin.z;
    packet.dir_x[0] = direction.x, packet.dir_y[0] = direction.y, packet.dir_z[0] = direction.z;
    packet.tfar[0] = kInfinity;
    packet.mask.fill(0xffffffffu);
    return packet;
}

InwardPath follow(const RayScene& rays, const BodyPoint& point, glm::vec3 direction, float limit) {
    InwardPath path;
    LaneMask first{};
    first[0] = -1;
    RayPacket packet = one_ray(point.inner, direction);
    std::int32_t shells = 0;
    for (int i = 0; i < kMostCrossings; ++i) {
        const PacketHits hits = rays.closest(first, packet);
        if (hits.hit[0] == 0) break;
        packet.tnear[0] = step_behind(hits, 0);
        if (hits.material[0] == point.material && hits.cosine[0] != 0.0f) {
            shells += hits.cosine[0] > 0 ? -1 : 1;
            path.steps.push_back({hits.distance[0], shells});
        }
    }
    // No shell remains at infinity, which fixes the number at the start. A path without any hit
    // starts inside and leaves through a hole.
    const std::int32_t start = path.steps.empty() ? 1 : std::max(0, -shells);
    for (InwardPath::Step& step : path.steps) {
        step.shells += start;
    }
    path.steps.insert(path.steps.begin(), {0.0f, start});
    // Depths count from `inner`, which is inside by no more than the rounding error of a hit.
    const float nothing = 4.0f * glm::distance(point.inner, point.position);
    for (const InwardPath::Step& step : path.steps) {
        path.nested = path.nested || step.shells > 1;
        if (step.shells <= 0) {
            path.length = step.depth > nothing ? std::min(step.depth, limit) : 0.0f;
            return path;
        }
    }
    path.open = true;
    path.length = limit;
    return path;
}

}  // namespace

InwardPath trace_inward_path(const RayScene& rays, const BodyPoint& point, float limit) {
    InwardPath path;
    if (point.normal == glm::vec3(0)) return path;
    path = follow(rays, point, -point.normal, limit);
    if (!path.open && shells_at(path, 0) == 1) return path;
    // A ray that aims exactly at a vertex or an edge, as in symmetric meshes and along the planes
    // of walls, may slip between triangles: it misses an exit, or counts a shell too many around
    // its start. Slightly tilted rays, along no axis, hit them, or confirm a hole or a shell.
    const glm::vec3 n = point.normal;
    const glm::vec3 aside =
        std::abs(n.x) < 0.5f ? glm::vec3(0, -n.z, n.y) : glm::vec3(-n.z, 0, n.x);
    const glm::vec3 tilt = 1e-3f * (0.8f * aside + 0.6f * glm::cross(n, aside));
    InwardPath one = follow(rays, point, glm::normalize(tilt - n), limit);
    if (path.open && !one.open) return one;
    InwardPath other = follow(rays, point, glm::normalize(-tilt - n), limit);
    if (path.open) return other;
    const bool is_outvoted = !other.open && shells_at(one, 0) == shells_at(other, 0);
    return is_outvoted ? other : path;
}

std::int32_t shells_at(const InwardPath& path, float depth) {
    std::int32_t shells = 0;
    for (const InwardPath::Step& step : path.steps) {
        if (step.depth > depth) break;
        shells = step.shells;
    }
    return shells;
}

std::vector<float> body_diagonals(const formats::Scene& scene) {
    std::vector<glm::vec3> low(scene.materials.size(), glm::vec3(kInfinity));
    std::vector<glm::vec3> high(scene.materials.size(), glm::vec3(-kInfinity));
    for (const formats::Primitive& p : scene.primitives) {
        for (const glm::vec3& v : p.position) {
            low[p.material] = glm::min(low[p.material], v);
            high[p.material] = glm::max(high[p.material], v);
        }
    }
    std::vector<float> diagonal(scene.materials.size(), 0.0f);
    for (std::size_t m = 0; m < diagonal.size(); ++m) {
        if (low[m].x <= high[m].x) {
            diagonal[m] = glm::length(high[m] - low[m]);
        }
    }
    return diagonal;
}

PacketEntries find_entries(const RayScene& rays, std::uint32_t material, LaneMask lanes,
                           RayPacket packet, std::array<std::int32_t, RayPacket::kSize> shells,
                           EntryCounts& counts) {
    PacketEntries entries{};
    LaneMask beyond{};
    for (int i = 0; i < kMostCrossings; ++i) {
        packet.tfar.fill(kInfinity);
        const PacketHits hits = rays.closest(lanes, packet);
        std::int32_t any = 0;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] == 0) continue;
            ++counts.rays;
            if (hits.hit[lane] == 0 || hits.material[lane] != material) {
                counts.missing += hits.hit[lane] == 0 ? 1u : 0u;
                lanes[lane] = 0;
                continue;
            }
            const float cosine = hits.cosine[lane];
            packet.tnear[lane] = step_behind(hits, lane);
            shells[lane] += cosine > 0 ? -1 : cosine < 0 ? 1 : 0;
            if (shells[lane] == 0) {
                entries.distance[lane] = hits.distance[lane];
                entries.cosine[lane] = cosine;
                entries.normal_x[lane] = hits.normal_x[lane];
                entries.normal_y[lane] = hits.normal_y[lane];
                entries.normal_z[lane] = hits.normal_z[lane];
                beyond[lane] = -1;
                lanes[lane] = 0;
            }
            any |= lanes[lane];
        }
        if (any == 0) break;
    }
    packet.tfar.fill(kInfinity);
    rays.occluded(beyond, packet);
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        counts.rays += static_cast<std::uint64_t>(-beyond[lane]);
        entries.lit[lane] = beyond[lane] != 0 && packet.tfar[lane] > 0.0f ? -1 : 0;
    }
    return entries;
}

}  // namespace opaline::bake
