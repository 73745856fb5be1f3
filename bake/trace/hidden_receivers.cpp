#include "bake/trace/hidden_receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
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

// For each hidden vertex, the nearest visible vertex that shares an edge with it; ties go to the
// first.
std::vector<std::uint32_t> nearest_visible(const formats::Scene& scene,
                                           const std::vector<Receiver>& receivers,
                                           const std::vector<bool>& hidden) {
    std::vector<std::uint32_t> nearest(receivers.size(), kNobody);
    std::vector<float> distance(receivers.size(), std::numeric_limits<float>::infinity());
    const auto offer = [&](std::uint32_t from, std::uint32_t to) {
        const float d = glm::distance(receivers[from].origin, receivers[to].origin);
        if (hidden[from] && !hidden[to] && d < distance[from]) {
            distance[from] = d;
            nearest[from] = to;
        }
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
    const std::vector<std::uint32_t> nearest = nearest_visible(scene, receivers, hidden);
    std::vector<Receiver> result = receivers;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (nearest[i] != kNobody) {
            result[i].origin = receivers[nearest[i]].origin;
        }
    }
    return result;
}

}  // namespace opaline::bake
