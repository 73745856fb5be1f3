#pragma once

#include <cstdint>
#include <span>

#include "bake/trace/direction_set.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Integral of the cosine over a cell of a block [sr]; <= 0 below the horizon.
inline float cosine_integral(const DirectionBlock& block, std::uint32_t lane, glm::vec3 normal) {
    return normal.x * block.moment_x[lane] + normal.y * block.moment_y[lane] +
           normal.z * block.moment_z[lane];
}

/// True if the whole block is below the horizon, or if there is no normal.
bool is_below(const DirectionBlock& block, glm::vec3 normal);

/// Traces a block from `packet`'s origins. Adds the cosine integrals of unoccluded cells, times the
/// boundary's transmittance (gather_irradiance), to the texels of `transport`. Returns the number
/// of rays: 0 in an empty scene.
std::uint64_t trace_block(const RayScene& rays, const DirectionBlock& block, glm::vec3 normal,
                          std::span<const float> transmittance, RayPacket& packet,
                          std::span<float> transport);

/// The same for a block that is known to be unoccluded.
void fill_block(const DirectionBlock& block, glm::vec3 normal, std::span<const float> transmittance,
                std::span<float> transport);

/// Turns integrals over texels into means.
void divide_by_solid_angle(const DirectionSet& directions, std::span<float> transport);

}  // namespace opaline::bake
