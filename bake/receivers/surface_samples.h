#pragma once

#include <cstdint>
#include <vector>

#include "bake/receivers/receiver.h"
#include "formats/scene.h"

namespace opaline::bake {

/// `count` blue-noise points, uniform by area over the triangles of the scene's primitives listed
/// in `primitives`, each carrying total area / count.
///
/// Method: weighted sample elimination [Yuksel2015] from 4 candidates per sample (5 for few), the
/// candidates stratified by area along the triangle list. Points with opposed normals do not repel
/// each other, so both sides of a thin sheet are covered. Serial elimination, counter-based random
/// numbers: the result depends on the scene and the seed alone.
///
/// Rays of a sample start above the facet, at the point that the smooth surface through the vertex
/// normals would have there [Hanika2021, shadow terminator], never below it.
/// Returns fewer points only if the surface has no area.
std::vector<SurfaceSample> sample_surface(const formats::Scene& scene,
                                          const std::vector<std::uint32_t>& primitives,
                                          std::uint32_t count, std::uint64_t seed);

}  // namespace opaline::bake
