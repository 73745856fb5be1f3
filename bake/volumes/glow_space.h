#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Light that a volume sends out by itself, as walks gather it. Cells as DensityVolume's.
struct GlowingGrid {
    const formats::SparseGrid<glm::vec3>* grid = nullptr;  ///< radiance per metre
    std::uint32_t volume = 0;                              ///< of the scene
    glm::mat3 to_index{1};                                 ///< index = to_index * position + offset
    glm::vec3 offset{0};
    glm::ivec3 first_cell{0}, extent{0};
    std::vector<float> bound;  ///< largest channel in each cell, x fastest
};

/// Those of these volumes that glow, in order. `scene` must outlive it.
std::vector<GlowingGrid> make_glowing_grids(const formats::Scene& scene,
                                            const std::vector<std::uint32_t>& volumes);

/// Radiance per metre integrated over `length` [m], maybe infinite, along a unit direction, by the
/// midpoint rule in steps of at most a voxel: W m^-2 sr^-1 if nothing absorbs.
glm::vec3 glow_along(const GlowingGrid& glow, glm::vec3 from, glm::vec3 direction, float length);

}  // namespace opaline::bake
