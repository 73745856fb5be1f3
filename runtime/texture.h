#pragma once

#include <cstdint>

#include "formats/opal/asset.h"
#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// Linear value of an 8-bit sRGB code (IEC 61966-2-1).
float linear_from_srgb(std::uint8_t code);

/// Bilinear sample of an image in linear light, or its nearest texel (formats::is_nearest); texel
/// centres at ((column + 1/2) / width, (row + 1/2) / height), uv (0, 0) at the top left as in glTF.
/// A coordinate that is not finite samples at 0. Precondition: the image is not empty.
formats::Rgb sample_image_linear(const formats::PreviewImage& image, formats::Float2 uv,
                                 formats::Wrap wrap_u, formats::Wrap wrap_v);

/// The same of the codes themselves, divided by 255: for images of linear values.
formats::Rgb sample_image_values(const formats::PreviewImage& image, formats::Float2 uv,
                                 formats::Wrap wrap_u, formats::Wrap wrap_v);

/// Base colour of one vertex: its stored colour times the primitive's image, where it has one.
/// `vertex` counts over the whole asset.
formats::Rgb vertex_base_color(const formats::AssetView& asset,
                               const formats::PrimitiveRecord& primitive, std::uint32_t vertex);

}  // namespace opaline::runtime
