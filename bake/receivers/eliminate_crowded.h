#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/surface_points.h"

namespace opaline::bake {

/// Removes the most crowded point, or nearly the most crowded, until `count` are left [Yuksel2015,
/// section 3]. Returns the indices of the remaining points, ascending. Points on different sides of
/// a sheet do not crowd each other. `area`: of the surface [m^2].
std::vector<std::uint32_t> eliminate_crowded(const std::vector<SurfacePoint>& points,
                                             std::size_t count, double area,
                                             const Context& context);

}  // namespace opaline::bake
