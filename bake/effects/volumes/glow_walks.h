#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Light that a volume sends out by itself, as walks gather it; bounds are of its largest channel.
struct GlowingGrid : CellGrid {
    const formats::SparseGrid<glm::vec3>* grid = nullptr;  ///< radiance per metre
    std::uint32_t volume = 0;                              ///< of the scene
};

/// Those of these volumes that glow, in order. `scene` must outlive it.
std::vector<GlowingGrid> make_glowing_grids(const formats::Scene& scene,
                                            const std::vector<std::uint32_t>& volumes);

/// Radiance per metre integrated over `length` [m], maybe infinite, along a unit direction, by the
/// midpoint rule in steps of at most a voxel: W m^-2 sr^-1 if nothing absorbs.
glm::vec3 glow_along(const GlowingGrid& glow, glm::vec3 from, glm::vec3 direction, float length);

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
