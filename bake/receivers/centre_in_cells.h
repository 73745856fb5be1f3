#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/surface_points.h"

namespace opaline::bake {

/// One step of Lloyd's relaxation: moves each point to the centroid of the surface nearest to it,
/// and measures the area of that cell. Sums weighted by these areas have a second-order error. With
/// a spacing equal to the width of the summed profile, equal weights err by 5 %, these areas by 0.7
/// %. `spacing` [m]: root of the area per point. Returns one area [m^2] per point; they add up to
/// the table's.
std::vector<float> centre_in_cells(const formats::Scene& scene, const AreaTable& table,
                                   double spacing, std::uint64_t seed,
                                   std::vector<SurfacePoint>& points, const Context& context);

}  // namespace opaline::bake
