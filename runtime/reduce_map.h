#pragma once

#include <cstdint>

#include "formats/opal/environment.h"

namespace opaline::runtime {

/// The map in a lower resolution: each new pixel is the mean over its cell of the old cells
/// (map_geometry.h), by exact solid angle, so flux is kept and a constant stays a constant. A size
/// that is already small enough stays. The result has no discs, and a lat-long map that had to
/// change has no pole rows. Needs not be a whole number of old pixels.
formats::Environment reduce_lat_long(const formats::Environment& map, std::uint32_t max_width,
                                     std::uint32_t max_height, unsigned threads);
formats::Environment reduce_cube(const formats::Environment& map, std::uint32_t max_size,
                                 unsigned threads);

}  // namespace opaline::runtime
