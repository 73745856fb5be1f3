#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/environment.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// What a pixel of a map radiates above its surroundings. Internal to integrate_map.
struct BrightPixel {
    std::uint32_t column = 0, row = 0;
    formats::Rgb radiance;
};

/// Clamps each band of the map to eight times its mean over the sphere and returns what was cut
/// off.
std::vector<BrightPixel> take_bright_pixels(formats::Environment& map);

/// Adds the flux radiance * solid angle of each pixel's cell, exactly, to the texels its bilinear
/// footprint covers. Meant for pixels smaller than texels. Bits do not depend on `threads`.
void project_small_sources(const formats::Environment& map, std::span<const BrightPixel> bright,
                           std::uint32_t n, const Rotation& rotation, unsigned threads,
                           std::span<double> integral);

}  // namespace opaline::runtime
