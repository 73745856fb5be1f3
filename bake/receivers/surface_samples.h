#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/receiver.h"
#include "bake/receivers/surface_points.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A sample at a point, with the normal that its vertices interpolate.
///
/// Its rays start above the facet, at the point that the smooth surface through the vertex normals
/// would have there [Hanika2021, shadow terminator], never below it. `area` [m^2].
SurfaceSample make_surface_sample(const formats::Scene& scene, const SurfacePoint& point,
                                  float area);

/// About `count` points, spread evenly over the triangles of the scene's primitives listed in
/// `primitives`, each with the area of the surface nearest to it; the areas add up to the surface.
///
/// Method: weighted sample elimination [Yuksel2015] from 4 candidates per sample (5 for few), the
/// candidates stratified by area along the triangle list, then one step of Lloyd's relaxation
/// (centre_in_cells.h). Points with opposed normals do not repel each other, so both sides of a
/// thin sheet are covered. Counter-based random numbers, fixed order: the result depends on the
/// scene and the seed alone.
/// Neighbours follow each other, in groups (kd_order.h).
/// Returns fewer points only where the surface has no area.
std::vector<SurfaceSample> sample_surface(const formats::Scene& scene,
                                          const std::vector<std::uint32_t>& primitives,
                                          std::uint32_t count, std::uint64_t seed,
                                          const Context& context);

}  // namespace opaline::bake
