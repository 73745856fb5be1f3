#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/scene/nearest_surface.h"

namespace opaline::bake {

/// Nodes of a regular grid.
struct GridNodes {
    glm::vec3 low{0};     ///< [m] of the first one
    float cell = 1;       ///< [m] between neighbours, > 0
    glm::uvec3 count{0};  ///< along each axis; x varies fastest

    std::size_t size() const { return std::size_t{count.x} * count.y * count.z; }
    std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (std::size_t{z} * count.y + y) * count.x + x;
    }
    glm::vec3 position(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return low + cell * glm::vec3(x, y, z);
    }
};

/// The nearest point of a surface to each node. Within two cells of the surface it is searched for;
/// farther away it is the nearest of those that the neighbours have [Danielsson1980], which errs by
/// a share of a cell. The same for any number of threads. All are kNone if no node is that near.
std::vector<NearestSurface::Place> find_nearest(const formats::Scene& scene,
                                                const NearestSurface& surface,
                                                const GridNodes& nodes);

}  // namespace opaline::bake
