#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/volumes/density_space.h"
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

}  // namespace opaline::bake
