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

/// A part of a bright pixel as a point, in the light's frame.
struct SmallSource {
    formats::Vec3 direction;
    formats::Rgb flux;  ///< [W m^-2]
};

/// Clamps each band of the map to eight times its mean over the sphere, or to twice its
/// surroundings, and returns what was cut off.
std::vector<BrightPixel> take_bright_pixels(formats::Environment& map);

/// Adds the flux radiance * solid angle of each pixel's cell, exactly, to the texels its bilinear
/// footprint covers. Meant for pixels smaller than texels. `shape`: the map, pixels not needed.
/// Bits do not depend on `threads`.
void project_small_sources(const formats::Environment& shape, std::span<const BrightPixel> bright,
                           std::uint32_t n, const Rotation& rotation, unsigned threads,
                           std::span<double> integral);

/// The same flux as 256 points a pixel, or 64, 16 or 4 where that makes more than 32768 points.
std::vector<SmallSource> divide_sources(const formats::Environment& shape,
                                        std::span<const BrightPixel> bright);

/// Adds each to the texel that it falls into. Never allocates.
void project_sources(std::span<const SmallSource> sources, std::uint32_t n,
                     const Rotation& rotation, std::span<double> integral);

}  // namespace opaline::runtime
