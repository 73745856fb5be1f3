#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/environment.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Adds the integral of a map's radiance over each of the 6 n n texels, integral[3 j + band]
/// [W m^-2]; discs are left out. Preconditions and threads as for project_environment.
///
/// - A cube map whose size is a multiple of n, turned by quarter turns or not at all: its pixels
/// are
///   summed by exact solid angle.
/// - Other maps: the bilinear map is sampled at s x s points of each texel. Each point is weighted
///   with the exact solid angle of its share, so that a constant map gives the texels' solid angles
///   to rounding. n s <= 1024 (2048 for n = 128); finer maps are first reduced (reduce_map.h).
/// - A grid of points misjudges pixels that are smaller than a texel and much brighter than their
///   surroundings (a sun in the map). Such pixels are subtracted from the map first and added one
///   by one with their exact flux (project_small_sources.h).
void integrate_map(const formats::Environment& map, std::uint32_t n, const Rotation& rotation,
                   unsigned threads, std::span<double> integral);

}  // namespace opaline::runtime
