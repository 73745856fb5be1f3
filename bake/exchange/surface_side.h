#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace opaline::bake {

/// Which scatterers may answer a ray: those of the surface's material and side that face as it
/// does.
struct SurfaceSide {
    std::uint32_t material = 0;
    bool behind = false;
    glm::vec3 normal{0};  ///< unit, of that side
};

/// Sides whose normals have the same nearest axis belong together, so that the two sides of a thin
/// part never mix.
inline constexpr std::size_t kSideAxes = 6;

inline glm::vec3 side_axis(std::size_t number) {
    glm::vec3 axis(0);
    axis[static_cast<glm::length_t>(number / 2)] = number % 2 == 0 ? 1.0f : -1.0f;
    return axis;
}

/// Index into kSideAxes.
inline std::size_t nearest_side_axis(glm::vec3 normal) {
    std::size_t best = 0;
    for (std::size_t a = 1; a < kSideAxes; ++a) {
        if (glm::dot(normal, side_axis(a)) > glm::dot(normal, side_axis(best))) {
            best = a;
        }
    }
    return best;
}

/// Number of the first axis of a material's side; below 2 kSideAxes times the materials.
inline std::size_t first_side_axis(std::uint32_t material, bool behind) {
    return (std::size_t{2} * material + (behind ? 1 : 0)) * kSideAxes;
}

}  // namespace opaline::bake
