#include "bake/trace/hidden_receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"

namespace opaline::bake {
namespace {

RayPacket probe_packet(const Receiver& receiver) {
    RayPacket packet = rays_from(receiver.origin);
    const auto directions = probe_directions(receiver.normal);
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        packet.dir_x[i] = directions[i].x;
        packet.dir_y[i] = directions[i].y;
        packet.dir_z[i] = directions[i].z;
    }
    packet.tfar.fill(std::numeric_limits<float>::infinity());
    return packet;
}

constexpr std::uint32_t kNobody = 0xffffffffu;

// A hidden vertex and a visible one that share an edge of a primitive.
struct HiddenEdge {
    std::uint32_t hidden, visible;
    float length;          // [m], between where their rays start
    bool is_seen = false;  // a part of it is seen that is more than rounding
};

std::vector<HiddenEdge> list_hidden_edges(const formats::Scene& scene,
                                          const std::vector<Receiver>& receivers,
                                          const std::vector<bool>& hidden) {
    std::vector<HiddenEdge> edges;
    const auto offer = [&](std::uint32_t from, std::uint32_t to) {
        if (!hidden[from] || hidden[to]) return;
        edges.push_back({from, to, glm::distance(receivers[from].origin, receivers[to].origin)});
    };
    std::uint32_t base = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i < p.index.size(); ++i) {
            const std::uint32_t a = base + p.index[i];
            const std::uint32_t b = base + p.index[i % 3 == 2 ? i - 2 : i + 1];
            offer(a, b);
            offer(b, a);
        }
        base += static_cast<std::uint32_t>(p.position.size());
    }
    return edges;
}

// An edge is seen from its visible end to where it enters what hides the other one.
void find_seen_parts(const RayScene& rays, const std::vector<Receiver>& receivers,
                     std::span<HiddenEdge> edges) {
    constexpr float kPart = 1e-3f;
    RayPacket packet = rays_from({});
    LaneMask lanes{};
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const glm::vec3 origin = receivers[edges[i].visible].origin;
        const glm::vec3 way = receivers[edges[i].hidden].origin - origin;
        packet.org_x[i] = origin.x, packet.dir_x[i] = way.x;
        packet.org_y[i] = origin.y, packet.dir_y[i] = way.y;
        packet.org_z[i] = origin.z, packet.dir_z[i] = way.z;
        packet.tfar[i] = kPart;
        lanes[i] = -1;
    }
    const PacketHits hits = rays.closest(lanes, packet);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        edges[i].is_seen = hits.hit[i] == 0;
    }
}

// For each hidden vertex, the nearest visible vertex that shares an edge with it: of those edges
// that are seen in part, if there are any; ties go to the first.
std::vector<std::uint32_t> nearest_visible(const RayScene& rays, const formats::Scene& scene,
                                           const std::vector<Receiver>& receivers,
                                           const std::vector<bool>& hidden,
                                           const Context& context) {
    std::vector<HiddenEdge> edges = list_hidden_edges(scene, receivers, hidden);
    for_each_block_in_order(
        edges.size(), RayPacket::kSize, context,
        [&](Range range) {
            find_seen_parts(rays, receivers,
                            std::span(edges).subspan(range.begin, range.end - range.begin));
            return true;
        },
        [](Range, bool) {});
    std::vector<const HiddenEdge*> best(receivers.size(), nullptr);
    for (const HiddenEdge& edge : edges) {
        const HiddenEdge*& own = best[edge.hidden];
        if (own == nullptr ||
            (edge.is_seen == own->is_seen ? edge.length < own->length : edge.is_seen)) {
            own = &edge;
        }
    }
    std::vector<std::uint32_t> nearest;
    nearest.reserve(best.size());
    for (const HiddenEdge* edge : best) {
        nearest.push_back(edge == nullptr ? kNobody : edge->visible);
    }
    return nearest;
}

}  // namespace

std::array<glm::vec3, RayPacket::kSize> probe_directions(glm::vec3 normal) {
    std::array<glm::vec3, RayPacket::kSize> directions;
    const Frame frame = make_frame(normal);
    for (std::uint32_t i = 0; i < RayPacket::kSize; ++i) {
        const float r2 = (static_cast<float>(i) + 0.5f) / static_cast<float>(RayPacket::kSize);
        const float phi =
            2.0f * std::numbers::pi_v<float> * (static_cast<float>(i) / std::numbers::phi_v<float>);
        const float r = std::sqrt(r2);
        directions[i] =
            frame.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - r2)});
    }
    return directions;
}

bool is_hidden(const RayScene& rays, const Receiver& receiver) {
    if (rays.is_empty() || receiver.normal == glm::vec3(0)) return false;
    LaneMask all;
    all.fill(-1);
    const LaneMask back = rays.meets_back_face(all, probe_packet(receiver));
    return std::all_of(back.begin(), back.end(), [](std::int32_t lane) { return lane != 0; });
}

std::vector<Receiver> replace_hidden_receivers(const RayScene& rays, const formats::Scene& scene,
                                               std::vector<Receiver> receivers,
                                               const Context& context) {
    if (rays.is_empty()) return receivers;
    std::vector<bool> hidden;
    for_each_block_in_order(
        receivers.size(), 1024, context,
        [&](Range range) {
            std::vector<bool> block;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                block.push_back(is_hidden(rays, receivers[i]));
            }
            return block;
        },
        [&](Range, const std::vector<bool>& block) {
            hidden.insert(hidden.end(), block.begin(), block.end());
        });
    hidden.resize(receivers.size());  // cancelled: there may be fewer
    const std::vector<std::uint32_t> nearest =
        nearest_visible(rays, scene, receivers, hidden, context);
    std::vector<Receiver> result = receivers;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (nearest[i] != kNobody) {
            result[i].origin = receivers[nearest[i]].origin;
        }
    }
    return result;
}

}  // namespace opaline::bake
