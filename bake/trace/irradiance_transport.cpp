#include "bake/trace/irradiance_transport.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opaline::bake {
namespace {

enum class Seen : std::uint8_t { nothing, open, blocked, mixed };

bool agrees(Seen seen) {
    return seen == Seen::open || seen == Seen::blocked;
}

struct Group {
    const RayScene& rays;
    const SharedDirections& directions;
    std::span<const Receiver> receivers;
    std::uint64_t traced = 0;

    const DirectionBlock& block(std::size_t i, std::size_t b) const {
        return directions.sets[i % directions.sets.size()].blocks[b];
    }

    bool is_above(std::size_t i, std::size_t b) const {
        return !is_below(block(i, b), receivers[i].normal);
    }

    // One ray through each cell of the block that is above some receiver's horizon. Receivers take
    // turns from `shift` on; a receiver with the cell below its horizon passes to the next.
    Seen probe(std::size_t b, std::size_t shift) {
        RayPacket packet{};
        packet.mask.fill(0xffffffffu);
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        LaneMask lanes{};
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            for (std::size_t turn = 0; turn < receivers.size() && lanes[lane] == 0; ++turn) {
                const std::size_t i = (lane + shift + turn) % receivers.size();
                if (cosine_integral(block(i, b), lane, receivers[i].normal) > 0.0f) {
                    const glm::vec3 origin = receivers[i].origin;
                    packet.org_x[lane] = origin.x;
                    packet.org_y[lane] = origin.y;
                    packet.org_z[lane] = origin.z;
                    packet.dir_x[lane] = block(i, b).dir_x[lane];
                    packet.dir_y[lane] = block(i, b).dir_y[lane];
                    packet.dir_z[lane] = block(i, b).dir_z[lane];
                    lanes[lane] = -1;
                }
            }
        }
        rays.occluded(lanes, packet);
        bool open = false, blocked = false;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const bool asked = lanes[lane] != 0, passed = packet.tfar[lane] > 0.0f;
            traced += asked ? 1 : 0;
            open |= asked && passed;
            blocked |= asked && !passed;
        }
        if (open && blocked) return Seen::mixed;
        return open ? Seen::open : blocked ? Seen::blocked : Seen::nothing;
    }

    std::vector<Seen> probe_all() {
        std::vector<Seen> seen(directions.beside.size(), Seen::nothing);
        for (std::size_t b = 0; b < seen.size(); ++b) {
            for (std::size_t i = 0; i < receivers.size() && seen[b] == Seen::nothing; ++i) {
                if (is_above(i, b)) {
                    seen[b] = probe(b, 0);
                    break;
                }
            }
        }
        return seen;
    }

    // Probes again beside blocks that differ, and around blocks that are found to differ then.
    void probe_borders(std::vector<Seen>& seen) {
        std::vector<std::size_t> left;
        for (std::size_t b = seen.size(); b-- > 0;) {
            left.push_back(b);
        }
        std::vector<bool> is_sure(seen.size(), false);
        while (!left.empty()) {
            const std::size_t b = left.back();
            left.pop_back();
            const auto differs = [&](std::uint32_t other) {
                return seen[other] != Seen::nothing && seen[other] != seen[b];
            };
            const std::vector<std::uint32_t>& beside = directions.beside[b];
            if (is_sure[b] || !agrees(seen[b]) ||
                std::none_of(beside.begin(), beside.end(), differs)) {
                continue;
            }
            is_sure[b] = true;
            for (std::size_t shift = 1; shift < directions.sets.size(); ++shift) {
                if (probe(b, shift) != seen[b]) {
                    seen[b] = Seen::mixed;
                    left.insert(left.end(), beside.begin(), beside.end());
                    break;
                }
            }
        }
    }
};

float look_up(const std::vector<float>& table, float cosine) {
    const float at = std::clamp(cosine, 0.0f, 1.0f) * static_cast<float>(table.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), table.size() - 2);
    return table[i] + (at - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

// Integral of the cosine over each subtexel, and whether any is above the horizon.
bool integrate_cosine(const DirectionBlock& block, glm::vec3 normal, RayPacket::Lane& cosine,
                      LaneMask& above) {
    std::int32_t any = 0;
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        cosine[lane] = cosine_integral(block, lane, normal);
        above[lane] = cosine[lane] > 0.0f ? -1 : 0;
        any |= above[lane];
    }
    return any != 0;
}

void weight_by_boundary(const DirectionBlock& block, glm::vec3 normal,
                        std::span<const float> transmittance, RayPacket::Lane& cosine) {
    const float steps = static_cast<float>(transmittance.size() - 1);
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        const float c = normal.x * block.dir_x[lane] + normal.y * block.dir_y[lane] +
                        normal.z * block.dir_z[lane];
        const float at = std::clamp(c, 0.0f, 1.0f) * steps;
        const auto i = std::min(static_cast<std::size_t>(at), transmittance.size() - 2);
        const float f = at - static_cast<float>(i);
        cosine[lane] *= transmittance[i] + f * (transmittance[i + 1] - transmittance[i]);
    }
}

}  // namespace

std::uint64_t gather_irradiance(const RayScene& rays, const DirectionSet& directions,
                                const Receiver& receiver, std::span<float> transport,
                                std::span<const float> transmittance) {
    std::fill(transport.begin(), transport.end(), 0.0f);
    RayPacket packet = rays_from(receiver.origin);
    std::uint64_t traced = 0;
    for (const DirectionBlock& block : directions.blocks) {
        if (!is_below(block, receiver.normal)) {
            traced += trace_block(rays, block, receiver.normal, transmittance, packet, transport);
        }
    }
    divide_by_solid_angle(directions, transport);
    return traced;
}

SharedDirections make_shared_directions(std::uint32_t cubemap_size) {
    SharedDirections shared;
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
        shared.sets[quarter] = make_sparse_direction_set(cubemap_size, quarter);
    }
    const std::vector<DirectionBlock>& blocks = shared.sets[0].blocks;
    shared.beside.resize(blocks.size());
    for (std::uint32_t a = 0; a < blocks.size(); ++a) {
        for (std::uint32_t b = 0; b < blocks.size(); ++b) {
            // Centres of squares are 1.4 radii apart across an edge and 2 across a corner. Cells
            // are distorted, so some of the latter are included.
            const float radii = blocks[a].sine_radius + blocks[b].sine_radius;
            if (a != b && glm::distance(blocks[a].axis, blocks[b].axis) < 0.85f * radii) {
                shared.beside[a].push_back(b);
            }
        }
    }
    return shared;
}

std::uint64_t gather_irradiance_together(const RayScene& rays, const SharedDirections& directions,
                                         std::span<const Receiver> receivers,
                                         std::span<float> transport,
                                         std::span<const float> transmittance) {
    std::fill(transport.begin(), transport.end(), 0.0f);
    const std::size_t size = receivers.empty() ? 0 : transport.size() / receivers.size();
    Group group{rays, directions, receivers};
    std::vector<Seen> seen(directions.beside.size(), Seen::open);
    if (!rays.is_empty()) {
        seen = group.probe_all();
        group.probe_borders(seen);
    }
    std::uint64_t traced = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const std::span<float> own = transport.subspan(i * size, size);
        const glm::vec3 normal = receivers[i].normal;
        RayPacket packet = rays_from(receivers[i].origin);
        for (std::size_t b = 0; b < seen.size(); ++b) {
            if (seen[b] == Seen::mixed && group.is_above(i, b)) {
                traced += trace_block(rays, group.block(i, b), normal, transmittance, packet, own);
            } else if (seen[b] == Seen::open && group.is_above(i, b)) {
                fill_block(group.block(i, b), normal, transmittance, own);
            }
        }
        divide_by_solid_angle(directions.sets[i % directions.sets.size()], own);
    }
    return group.traced + traced;
}

std::uint64_t gather_banded_irradiance(const RayScene& rays, const DirectionSet& directions,
                                       const Receiver& receiver,
                                       std::span<const std::vector<float>> factor,
                                       std::span<float> transport) {
    std::fill(transport.begin(), transport.end(), 0.0f);
    const std::size_t texels = directions.inverse_solid_angle.size();
    const glm::vec3 n = receiver.normal;
    RayPacket packet = rays_from(receiver.origin);
    const bool is_open = rays.is_empty();
    std::uint64_t traced = 0;
    for (const DirectionBlock& block : directions.blocks) {
        if (is_below(block, n)) continue;
        LaneMask lanes;
        RayPacket::Lane cosine;  // integrated over each cell
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            cosine[lane] = cosine_integral(block, lane, n);
            lanes[lane] = cosine[lane] > 0.0f ? -1 : 0;
            traced += is_open ? 0 : static_cast<std::uint64_t>(-lanes[lane]);
        }
        packet.dir_x = block.dir_x;
        packet.dir_y = block.dir_y;
        packet.dir_z = block.dir_z;
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        if (!is_open) {
            rays.occluded(lanes, packet);
        }
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] != 0 && packet.tfar[lane] > 0.0f) {
                const float c =
                    glm::dot(n, {block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]});
                for (std::size_t b = 0; b < factor.size(); ++b) {
                    transport[b * texels + block.texel[lane]] +=
                        cosine[lane] * look_up(factor[b], c);
                }
            }
        }
    }
    for (std::size_t b = 0; b < factor.size(); ++b) {
        divide_by_solid_angle(directions, transport.subspan(b * texels, texels));
    }
    return traced;
}

std::uint64_t trace_block(const RayScene& rays, const DirectionBlock& block, glm::vec3 normal,
                          std::span<const float> transmittance, RayPacket& packet,
                          std::span<float> transport) {
    if (rays.is_empty()) {
        fill_block(block, normal, transmittance, transport);
        return 0;
    }
    RayPacket::Lane cosine;
    LaneMask lanes;
    if (!integrate_cosine(block, normal, cosine, lanes)) return 0;
    if (!transmittance.empty()) {
        weight_by_boundary(block, normal, transmittance, cosine);
    }
    packet.dir_x = block.dir_x;
    packet.dir_y = block.dir_y;
    packet.dir_z = block.dir_z;
    packet.tfar.fill(std::numeric_limits<float>::infinity());
    rays.occluded(lanes, packet);
    std::uint64_t traced = 0;
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        traced += static_cast<std::uint64_t>(-lanes[lane]);
        const bool lit = lanes[lane] != 0 && packet.tfar[lane] > 0.0f;
        transport[block.texel[lane]] += lit ? cosine[lane] : 0.0f;
    }
    return traced;
}

void fill_block(const DirectionBlock& block, glm::vec3 normal, std::span<const float> transmittance,
                std::span<float> transport) {
    RayPacket::Lane cosine;
    LaneMask lanes;
    if (!integrate_cosine(block, normal, cosine, lanes)) return;
    if (!transmittance.empty()) {
        weight_by_boundary(block, normal, transmittance, cosine);
    }
    for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
        transport[block.texel[lane]] += lanes[lane] != 0 ? cosine[lane] : 0.0f;
    }
}

// The whole block is below the horizon if its axis is below by more than the block's radius:
// angle(n, axis) > 90 degrees + radius, i.e. dot(n, axis) < -sin(radius).
bool is_below(const DirectionBlock& block, glm::vec3 normal) {
    return normal == glm::vec3(0) || glm::dot(normal, block.axis) < -block.sine_radius;
}

void divide_by_solid_angle(const DirectionSet& directions, std::span<float> transport) {
    for (std::size_t j = 0; j < transport.size(); ++j) {
        transport[j] *= directions.inverse_solid_angle[j];
    }
}

}  // namespace opaline::bake
