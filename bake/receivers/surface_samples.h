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
/// Its rays start at the point of the smooth surface through the vertex normals, and never below
/// the facet [Hanika2021, shadow terminator]. `area` [m^2].
SurfaceSample make_surface_sample(const formats::Scene& scene, const SurfacePoint& point,
                                  float area);

/// About `count` points, spread evenly over the triangles of the scene's primitives listed in
/// `primitives`. Each has the area of its cell; the areas add up to the surface.
///
/// Method: weighted sample elimination [Yuksel2015] from 4 candidates per sample (5 for few), the
/// candidates stratified by area along the triangle list, then one step of Lloyd's relaxation
/// (surface_samples.h). Points with opposed normals do not repel each other, so both sides of a
/// thin sheet are covered. The result depends on the scene and the seed only. Samples are in
/// kd-order (kd_order.h). Returns fewer points only where the surface has no area.
std::vector<SurfaceSample> sample_surface(const formats::Scene& scene,
                                          const std::vector<std::uint32_t>& primitives,
                                          std::uint32_t count, std::uint64_t seed,
                                          const Context& context);

}  // namespace opaline::bake
