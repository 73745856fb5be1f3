#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/environment.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Adds the integral of a map's radiance over each of the 6 n n texels, integral[3 j + band]
/// [W m^-2]; discs are left out. Preconditions and threads as for project_environment.
///
/// - A cube map whose size is a multiple of n, turned by quarter turns or not at all: its texels
/// are
///   summed by exact solid angle.
/// - Everything else: the bilinear map is sampled at s x s points of each texel, each weighted by
/// the
///   exact solid angle of its share, so that a constant map gives the texels' solid angles to
///   rounding. n s <= 1024 (2048 for n = 128); maps too fine for that are first
///   reduced (reduce_map.h).
/// - Where pixels are smaller than texels, points on a grid would catch a little too much or too
///   little of a pixel that outshines its surroundings (a sun in the map). What stands out is
///   therefore taken off and dealt out pixel by pixel with its exact flux (deal_out.h).
void integrate_map(const formats::Environment& map, std::uint32_t n, const Rotation& rotation,
                   unsigned threads, std::span<double> integral);

}  // namespace opaline::runtime
