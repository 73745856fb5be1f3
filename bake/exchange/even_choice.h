#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/exchange/surface_side.h"

namespace opaline::bake {

/// A place on one side of a surface.
struct SidePoint {
    glm::vec3 position{0};  ///< [m]
    SurfaceSide side;
};

/// Indices of at most `count` of the points, each near the middle of as many neighbours on its side
/// as the others have: as dense as all points are, and evenly spaced.
std::vector<std::uint32_t> choose_evenly(std::span<const SidePoint> points, std::size_t count);

}  // namespace opaline::bake
