#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "bake/transport/ray_scene.h"
#include "bake/volumes/density_space.h"
#include "bake/volumes/glow_space.h"

namespace opaline::bake {

/// What walks to light of volumes share, read-only.
struct GlowWalkSpace {
    const DensitySpace& space;
    std::span<const GlowingGrid> glow;
    const RayScene& rays;
    std::uint64_t seed = 0;
};

/// A point at which the scattered part of that light is estimated.
struct GlowReceiver {
    std::uint32_t volume = 0;
    std::size_t node = 0;      ///< the random numbers depend on it
    glm::vec3 position{0};     ///< [m]
    std::uint32_t walks = 64;  ///< W
    std::uint32_t terms = 1;   ///< K_e: 1, 4, 9, 16 or 25
};

/// E_k of a node (README.md, "Light of volumes"): coefficients of J [W m^-2 sr^-1] by harmonics of
/// the direction toward the eye. `out`: one for each glowing grid and term, grid after grid,
/// overwritten. Returns the rays traced.
std::uint64_t gather_glow(const GlowWalkSpace& walk, const GlowReceiver& receiver,
                          std::span<glm::vec3> out);

}  // namespace opaline::bake
