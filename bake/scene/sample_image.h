#pragma once

#include <glm/glm.hpp>

#include "formats/image/image.h"
#include "formats/scene.h"

namespace opaline::bake {

/// An image and how it is looked up.
struct ImageLookup {
    const formats::Image8& image;  ///< not empty
    formats::TextureWrap wrap_u, wrap_v;
    bool is_linear;  ///< red, green and blue are values times 255; else sRGB. Alpha is linear
};

/// Bilinear in linear light, or the nearest texel where the wrap modes say so; texel centres at
/// ((column + 1/2) / width, (row + 1/2) / height), uv (0, 0) at the top left. Coordinates beyond a
/// million sample at 0: there, floats do not resolve texels.
glm::vec4 sample_image(const ImageLookup& lookup, glm::vec2 uv);

/// Its alpha alone.
float sample_alpha(const ImageLookup& lookup, glm::vec2 uv);

}  // namespace opaline::bake
