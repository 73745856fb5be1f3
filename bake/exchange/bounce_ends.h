#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/scatterers.h"

namespace opaline::bake {

/// What the ray of a cell, or of a quarter of one, meets.
struct BounceEnd {
    glm::vec3 direction{0};      ///< unit
    float distance = 0;          ///< [m]
    float error = 0;             ///< bound [m] on that of where it ends
    std::uint32_t material = 0;  ///< and side: of the surface that is met
    SeenSide side;
    TrianglePlace triangle{};
    bool is_met = false, is_quarter = false;
    std::uint32_t cell = 0;  ///< of BounceGrid::cells, or quarters

    bool sends() const { return is_met && side.is_seen; }
};

/// Rays of a point, one a cell. Cells whose neighbours see different surfaces have one ray in each
/// quarter instead, as many as the grid has rays for. A cell's own ray does not influence whether
/// the cell is cut, and stays one of the four, so the estimate is unbiased: a ray that meets a thin
/// object is rare and counts in full. Overwrites `ends`; the first are those of cells, row by row.
/// Returns the rays.
std::uint64_t find_bounce_ends(const formats::Scene& scene, const RayScene& rays,
                               const Receiver& at, const BounceGrid& grid, std::uint64_t seed,
                               std::vector<BounceEnd>& ends);

}  // namespace opaline::bake
