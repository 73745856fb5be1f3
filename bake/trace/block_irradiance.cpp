#include "bake/trace/block_irradiance.h"

#include <algorithm>
#include <limits>

namespace opaline::bake {
namespace {

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
