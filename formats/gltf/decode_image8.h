#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "formats/image/image.h"

namespace opaline::formats::gltf {

/// An image, or what is wrong with it.
struct DecodedImage8 {
    Image8 image;
    std::string fault;  ///< empty on success
};

/// Decodes PNG or JPEG, told apart by content, to sRGB plus alpha. Colour profiles and gamma are
/// ignored, as the glTF specification asks of base-colour textures; 16-bit PNG is rounded to 8.
/// Safe on hostile bytes; refuses more than kMaxImageSide on a side or kMaxImagePixels in all.
DecodedImage8 decode_image8(std::span<const std::byte> bytes);

}  // namespace opaline::formats::gltf
