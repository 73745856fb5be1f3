#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// A rendered image: linear Rec. 709 radiance [W m^-2 sr^-1], finite, >= 0; row-major, row 0 on
/// top: pixel[y * width + x].
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<formats::Rgb> pixel;
};

/// Largest width and height of a picture, in pixels, of either backend.
inline constexpr std::uint32_t kMaxPictureSize = 16384;

/// A black picture. Errors: resource, where there is no memory for it.
formats::Result<Picture> make_picture(std::uint32_t width, std::uint32_t height);

}  // namespace opaline::runtime
