#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/opal/rgb.h"

namespace opaline::formats {

/// Linear RGB float image, row-major, row 0 on top; `pixel[y * width + x]`.
/// For environments: radiance, finite and >= 0 once loaded (see load_environment).
struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<Rgb> pixel;
};

/// One number a pixel, row-major, row 0 on top.
struct ScalarImage {
    std::uint32_t width = 0, height = 0;
    std::vector<float> value;
};

/// 8-bit colour image as stored in textures and PNG files: sRGB-encoded RGB plus linear alpha,
/// four bytes a pixel, row-major, row 0 on top.
struct Image8 {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

}  // namespace opaline::formats
