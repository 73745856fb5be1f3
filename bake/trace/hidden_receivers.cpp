#include "bake/trace/hidden_receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"
#include "bake/scene/triangle.h"

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

struct OwnVertex {
    glm::vec3 position, normal;
    std::uint32_t number;  // of the scene
};

// Whether there is no body before the triangle near some of its corners.
std::vector<std::uint8_t> seen_corners(const BodiesAt& bodies, const formats::Primitive& p,
                                       std::size_t first_index) {
    constexpr float kInward = 0.05f;  // edges of triangles lie on those of other bodies
    std::vector<std::uint8_t> seen(3);
    const glm::vec3 normal = triangle_normal(p, first_index / 3);
    if (normal == glm::vec3(0)) return seen;
    glm::vec3 middle(0);
    for (std::size_t k = 0; k < 3; ++k) {
        middle += p.position[p.index[first_index + k]] / 3.0f;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 at = glm::mix(p.position[p.index[first_index + k]], middle, kInward);
        seen[k] = bodies.material_at(at + 2 * bodies.touch() * normal) == formats::kNone ? 1 : 0;
    }
    return seen;
}

// Of a primitive's vertices; `meets`: its material touches or overlaps others.
std::vector<std::uint8_t> seen_vertices(const BodiesAt& bodies, const formats::Primitive& p,
                                        bool meets, const Context& context) {
    std::vector<std::uint8_t> seen(p.position.size());
    constexpr std::size_t kBlock = 256;
    for_each_block_in_order(
        p.index.size() / 3, kBlock, context,
        [&](Range range) {
            std::vector<std::uint8_t> corners;
            for (std::size_t t = range.begin; t < range.end; ++t) {
                const auto own =
                    meets ? seen_corners(bodies, p, 3 * t) : std::vector<std::uint8_t>(3, 1);
                corners.insert(corners.end(), own.begin(), own.end());
            }
            return corners;
        },
        [&](Range range, std::vector<std::uint8_t>&& corners) {
            for (std::size_t c = 0; c < corners.size(); ++c) {
                std::uint8_t& of = seen[p.index[3 * range.begin + c]];
                of = std::max(of, corners[c]);
            }
        });
    return seen;
}

// `sorted` along x.
std::uint32_t nearest_seen(std::span<const OwnVertex> sorted, const OwnVertex& hidden) {
    constexpr float kAlike = 0.7f, kOtherWay = 2;
    const auto middle = std::ranges::lower_bound(sorted, hidden.position.x, {},
                                                 [](const OwnVertex& v) { return v.position.x; });
    float least = std::numeric_limits<float>::infinity();
    std::uint32_t nearest = hidden.number;
    const auto look_at = [&](const OwnVertex& v) {
        if (!(std::abs(v.position.x - hidden.position.x) < least)) return false;
        const float factor = glm::dot(v.normal, hidden.normal) > kAlike ? 1 : kOtherWay;
        const float distance = factor * glm::distance(v.position, hidden.position);
        if (distance < least || (distance == least && v.number < nearest)) {
            least = distance;
            nearest = v.number;
        }
        return true;
    };
    for (auto v = middle; v != sorted.end() && look_at(*v); ++v) {
    }
    for (auto v = middle; v != sorted.begin() && look_at(*(v - 1)); --v) {
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

std::vector<std::uint32_t> find_stand_ins(const formats::Scene& scene, const SceneFacts& facts,
                                          const EmbreeScene& triangles, const Context& context) {
    std::size_t count = 0;
    for (const formats::Primitive& p : scene.primitives) {
        count += p.position.size();
    }
    std::vector<std::uint32_t> stand_in(count);
    std::iota(stand_in.begin(), stand_in.end(), 0u);
    if (triangles.triangles() == 0) return stand_in;
    const BodiesAt bodies(scene, triangles);
    for (const std::uint32_t material : bodies.order()) {
        const auto& inner = facts.material[material].inner;
        std::vector<std::uint8_t> is_own(scene.materials.size());
        is_own[material] = 1;
        const bool meets =
            std::ranges::any_of(inner, [](const InnerMedium& i) { return i.depth == 0; }) ||
            facts.material[material].overlaps || bodies.has_faces_on_faces(scene, is_own);
        std::vector<OwnVertex> seen, hidden;
        std::uint32_t first = 0;
        for (const formats::Primitive& p : scene.primitives) {
            if (p.material == material) {
                const std::vector<std::uint8_t> own = seen_vertices(bodies, p, meets, context);
                for (std::size_t v = 0; v < own.size(); ++v) {
                    (own[v] != 0 ? seen : hidden)
                        .push_back(
                            {p.position[v], p.normal[v], first + static_cast<std::uint32_t>(v)});
                }
            }
            first += static_cast<std::uint32_t>(p.position.size());
        }
        std::ranges::stable_sort(seen, {}, [](const OwnVertex& v) { return v.position.x; });
        for (const OwnVertex& v : hidden) {
            stand_in[v.number] = nearest_seen(seen, v);
        }
    }
    return stand_in;
}

}  // namespace opaline::bake
