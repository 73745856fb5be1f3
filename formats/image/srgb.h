#pragma once

#include "formats/image/image.h"

namespace opaline::formats {

/// sRGB transfer function of IEC 61966-2-1: encoded value in [0, 1] to linear in [0, 1].
float linear_from_srgb(float encoded);

/// Inverse of `linear_from_srgb`; the argument is clamped to [0, 1] first, NaN becomes 0.
float srgb_from_linear(float linear);

/// Linear colours of an 8-bit image; alpha is ignored.
Image to_linear(const Image8& image);

/// 8-bit sRGB of a linear image: clamped to [0, 1], rounded to nearest, alpha 255.
Image8 to_srgb(const Image& image);

}  // namespace opaline::formats
