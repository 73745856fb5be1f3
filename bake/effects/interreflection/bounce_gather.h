#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/effects/interreflection/bounce_tree.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// Rays that `wanted` becomes: the square of a multiple of 4, at least 16.
inline std::uint32_t count_bounce_rays(double wanted) {
    const double side = 4 * std::max(1.0, std::round(0.25 * std::sqrt(wanted)));
    return static_cast<std::uint32_t>(side * side);
}

/// Key of a point's random numbers: a hash of its place and normal, so that copies of a vertex
/// gather the same.
inline std::uint64_t key_of(const Receiver& at) {
    std::uint64_t key = 0x9e3779b97f4a7c15u;
    for (const float value :
         {at.origin.x, at.origin.y, at.origin.z, at.normal.x, at.normal.y, at.normal.z}) {
        key = (key ^ std::bit_cast<std::uint32_t>(value)) * 0xff51afd7ed558ccdu;
        key ^= key >> 32;
    }
    return key;
}

/// The point of the unit disk of two numbers in [0, 1]: concentric squares become circles.
inline glm::vec2 to_disk(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) {
        return glm::vec2(0);
    }
    constexpr float kQuarter = std::numbers::pi_v<float> / 4;
    const bool first = std::abs(a) > std::abs(b);
    const float r = first ? a : b;
    const float angle = first ? kQuarter * (b / a) : 2 * kQuarter - kQuarter * (a / b);
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// Traces `count` (count_bounce_rays) cosine-distributed rays, one in each cell of a square grid,
/// in packets of neighbouring cells. Calls visit(hits, packet, lane, cos_x) for each hit in a fixed
/// order, cos_x the cosine at the point. Returns the rays. A point without a normal traces none.
template <class Visit>
std::uint64_t trace_bounces(const RayScene& rays, const Receiver& at, std::uint32_t count,
                            std::uint64_t seed, Visit&& visit) {
    if (at.normal == glm::vec3(0) || rays.is_empty()) {
        return 0;
    }
    const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<float>(count))));
    const float width = 1 / static_cast<float>(side);
    const Frame frame = make_frame(at.normal);
    const std::uint64_t key = key_of(at);
    RayPacket packet = rays_from(at.origin);
    LaneMask lanes;
    lanes.fill(-1);
    RayPacket::Lane cosine{};
    std::uint32_t number = 0;
    for (std::uint32_t row = 0; row < side; row += 4) {
        for (std::uint32_t column = 0; column < side; column += 4, ++number) {
            for (std::uint32_t i = 0; i < RayPacket::kSize; i += 2) {
                const auto u =
                    random_uniform(seed, RandomStage::bounce_rays, key, 8 * number + i / 2);
                for (std::uint32_t j = 0; j < 2; ++j) {
                    const std::uint32_t lane = i + j;
                    const std::uint32_t across = column + lane % 4, along = row + lane / 4;
                    const glm::vec2 d = to_disk((static_cast<float>(across) + u[2 * j]) * width,
                                                (static_cast<float>(along) + u[2 * j + 1]) * width);
                    const float z = std::sqrt(std::max(0.0f, 1 - glm::dot(d, d)));
                    const glm::vec3 direction = frame.to_world({d.x, d.y, z});
                    packet.dir_x[lane] = direction.x;
                    packet.dir_y[lane] = direction.y;
                    packet.dir_z[lane] = direction.z;
                    packet.tfar[lane] = std::numeric_limits<float>::infinity();
                    cosine[lane] = z;
                }
            }
            const PacketHits hits = rays.closest(lanes, packet);
            for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
                if (hits.hit[lane] != 0) {
                    visit(hits, packet, lane, cosine[lane]);
                }
            }
        }
    }
    return count;
}

/// A node of the tree and its share of a point's irradiance.
struct NodeWeight {
    std::uint32_t node = 0;
    float weight = 0;
};

/// The irradiance at a point as a sum over nodes, ascending: E = sum of weight * mean B of the
/// node,
///     E = 1/N sum over N cosine-distributed rays of B where each ends,
/// the node chosen by the ray's footprint, a_f = pi t^2 / (N cos_x cos_y) (path_differentials.h:
/// the polygon of a cosine lobe with local steps N^(-1/2), moved to the surface). `nearest`: the
/// nearest scatterer instead, whatever the footprint. Overwrites `weights`; returns the rays.
std::uint64_t weigh_bounces(const formats::Scene& scene, const RayScene& rays,
                            const BounceTree& tree, const Receiver& at, std::uint32_t count,
                            std::uint64_t seed, std::vector<NodeWeight>& weights,
                            bool nearest = false);

/// Adds sum of weight * row of the node to `rows`, one as long as those of the tree.
void add_node_rows(const BounceTree& tree, std::span<const NodeWeight> weights,
                   std::span<float> rows);

/// Adds `bands` planes of 6 m m Haar coefficients to planes of 6 n n, n >= m: the same map in
/// smaller texels.
void add_to_finer(std::span<const float> from, std::uint32_t m, std::span<float> to,
                  std::uint32_t n, std::uint32_t bands);

}  // namespace opaline::bake
