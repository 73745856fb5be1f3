#pragma once

#include <cstdint>

#include "formats/image/image.h"
#include "formats/opal/environment.h"

namespace opaline::bake {

/// The whole environment, discs included, as a lat-long image with +X in its centre (our
/// convention for files). Each disc is spread over the pixels it covers and scaled so that the sum
/// of radiance times exact pixel solid angle is its flux; the map is averaged over each pixel (and
/// copied where size and orientation agree). Width and height at least 1.
formats::Image rasterise_lat_long(const formats::Environment& environment, std::uint32_t width,
                                  std::uint32_t height);

/// Exact solid angle [sr] of a pixel in a row of a lat-long image; it is the same in all columns.
double lat_long_pixel_solid_angle(std::uint32_t width, std::uint32_t height, std::uint32_t row);

}  // namespace opaline::bake
