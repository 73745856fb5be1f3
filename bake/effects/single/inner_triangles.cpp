#include "bake/effects/single/inner_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kPoints = 4, kRays = 3;

struct Triangle {
    std::array<glm::vec3, 3> corner;
};

std::vector<Triangle> triangles_of(const formats::Scene& scene, std::uint32_t material) {
    std::vector<Triangle> all;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; p.material == material && i + 2 < p.index.size(); i += 3) {
            all.push_back(
                {{p.position[p.index[i]], p.position[p.index[i + 1]], p.position[p.index[i + 2]]}});
        }
    }
    return all;
}

// Number of shells of the medium around the start of each ray: shells left minus shells entered on
// the way to infinity.
std::array<std::int32_t, RayPacket::kSize> count_shells(const RayScene& rays,
                                                        std::uint32_t material, LaneMask lanes,
                                                        RayPacket packet) {
    std::array<std::int32_t, RayPacket::kSize> shells{};
    constexpr int kMostCrossings = 256;  // bounds the work for a hostile mesh
    for (int i = 0; i < kMostCrossings; ++i) {
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        const PacketHits hits = rays.closest(lanes, packet);
        std::int32_t any = 0;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] == 0 || hits.hit[lane] == 0) {
                lanes[lane] = 0;
                continue;
            }
            if (hits.material[lane] == material) {
                shells[lane] += hits.cosine[lane] > 0 ? 1 : hits.cosine[lane] < 0 ? -1 : 0;
            }
            packet.tnear[lane] =
                hits.distance[lane] + std::max(hits.error[lane], 1e-6f * hits.distance[lane]);
            any |= lanes[lane];
        }
        if (any == 0) break;
    }
    return shells;
}

// The rays of one triangle are one packet; its last four lanes stay empty.
bool lies_inside(const RayScene& rays, std::uint32_t material, const Triangle& triangle) {
    const auto& [a, b, c] = triangle.corner;
    const glm::vec3 across = glm::cross(b - a, c - a);
    const float area = glm::length(across);
    if (!(area > 0)) return false;
    const glm::vec3 normal = across / area;
    const glm::vec3 tangent = glm::normalize(b - a);
    const glm::vec3 other = glm::cross(normal, tangent);
    const std::array<glm::vec3, kRays> direction{
        normal, glm::normalize(normal + 0.7f * tangent + 0.4f * other),
        glm::normalize(normal - 0.5f * tangent - 0.6f * other)};
    const glm::vec3 reach = glm::max(glm::abs(b - a), glm::abs(c - a));
    constexpr float kClear = 4.0f;  // of the triangle itself, by rounding errors
    const float clear = kClear * clearance_bound(a, std::max({reach.x, reach.y, reach.z}));
    RayPacket packet{};
    packet.mask.fill(0xffffffffu);
    LaneMask lanes{};
    for (std::size_t p = 0; p < kPoints; ++p) {
        glm::vec3 weight(p == 3 ? 1.0f / 3.0f : 0.1f);
        if (p < 3) {
            weight[static_cast<glm::length_t>(p)] = 0.8f;
        }
        const glm::vec3 origin = weight.x * a + weight.y * b + weight.z * c + clear * normal;
        for (std::size_t r = 0; r < kRays; ++r) {
            const std::size_t lane = p * kRays + r;
            set_origin(packet, lane, origin);
            set_lane(packet, lanes, lane, direction[r]);
        }
    }
    const auto shells = count_shells(rays, material, lanes, packet);
    return *std::min_element(shells.begin(), shells.begin() + kPoints * kRays) >= 1;
}

}  // namespace

std::vector<std::uint8_t> find_inner_triangles(const formats::Scene& scene, const RayScene& rays,
                                               std::uint32_t material, const Context& context) {
    const std::vector<Triangle> triangles = triangles_of(scene, material);
    std::vector<std::uint8_t> inner;
    inner.reserve(triangles.size());
    constexpr std::size_t kBlock = 1024;
    for_each_block_in_order(
        triangles.size(), kBlock, context,
        [&](Range range) {
            std::vector<std::uint8_t> part;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                part.push_back(lies_inside(rays, material, triangles[i]) ? 1 : 0);
            }
            return part;
        },
        [&](Range, std::vector<std::uint8_t>&& part) {
            inner.insert(inner.end(), part.begin(), part.end());
        });
    inner.resize(triangles.size(), 0);
    return inner;
}

}  // namespace opaline::bake
