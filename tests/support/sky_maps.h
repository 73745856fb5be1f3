#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "formats/opal/environment.h"

namespace opaline::tests {

/// Pixel (column, row) of a lat-long map in the default orientation looks this way.
inline formats::Vec3 lat_long_direction(std::uint32_t width, std::uint32_t height,
                                        std::uint32_t column, std::uint32_t row) {
    const double phi = 2.0 * std::numbers::pi * ((column + 0.5) / width - 0.5);
    const double theta = std::numbers::pi * (row + 0.5) / height;
    return {static_cast<float>(std::sin(theta) * std::cos(phi)),
            static_cast<float>(std::cos(theta)),
            static_cast<float>(std::sin(theta) * std::sin(phi))};
}

/// A map of a function of direction.
template <class Function>
formats::Environment lat_long_map(std::uint32_t width, std::uint32_t height, const Function& f) {
    formats::Environment map;
    map.width = width;
    map.height = height;
    for (std::uint32_t row = 0; row < height; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
            map.pixel.push_back(f(lat_long_direction(width, height, column, row)));
        }
    }
    return map;
}

/// The same as a cube map of n x n texels a face.
template <class Function>
formats::Environment cube_map(std::uint32_t n, const Function& f) {
    formats::Environment map;
    map.layout = formats::Environment::Layout::cube;
    map.width = n;
    map.height = 6 * n;
    for (std::uint32_t row = 0; row < 6 * n; ++row) {
        for (std::uint32_t column = 0; column < n; ++column) {
            map.pixel.push_back(f(formats::texel_direction(n, row / n, row % n, column)));
        }
    }
    return map;
}

}  // namespace opaline::tests
