#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "bake/emitters/surface_elements.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// Where a ray meets a surface.
struct Arrival {
    TriangleSide side;
    glm::dvec3 weights{0};  ///< barycentric
    glm::dvec3 normal{0};   ///< unit, of the side met
    std::uint32_t material = 0;
    double distance = 0, error = 0;  ///< along the ray; of the position [m]
};

/// Nothing where the ray met nothing, or a triangle edge-on.
std::optional<Arrival> arrival_of(const PacketHits& hits, std::size_t lane);
std::optional<Arrival> find_arrival(const RayScene& surfaces, const glm::vec3& from,
                                    const glm::vec3& direction);

/// In front of a surface that a ray met, on the side that its normal points to: back along the ray,
/// as what is beside the surface may be outside in a corner. Or on the other side.
glm::dvec3 leave_surface(const glm::dvec3& from, const glm::dvec3& direction, const Arrival& at,
                         bool crosses);

}  // namespace opaline::bake
