#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/rgb.h"
#include "runtime/picture/picture.h"

namespace opaline::runtime {

/// A picture ready for a screen or a PNG file: 8-bit sRGB, four bytes a pixel, alpha 255, row 0 on
/// top.
struct DisplayPicture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Linear display colour, each band in [0, 1], from linear radiance. Up to its shoulder at 0.76 the
/// Khronos PBR Neutral tone mapper (Khronos Group, "PBR Neutral Tone Mapper" specification, 2024):
/// base colours keep their hue and saturation. Above, its compression is applied to each band by
/// itself, where the specification scales all bands alike: fire then goes from orange over yellow
/// to white, as on film, and not to salmon. Its desaturation follows. Greys are the
/// specification's. Any input: negative values and NaN count as 0, infinity as the largest number.
formats::Rgb tone_map_neutral(formats::Rgb radiance);

/// sRGB transfer function (IEC 61966-2-1), linear [0, 1] to encoded [0, 1].
float encode_srgb(float linear);

/// How radiance becomes display colour: tone_map_neutral, or cut off at 1, which shows radiance
/// below 1 as it is.
enum class ToneMap { neutral, none };

/// Radiance times 2^exposure_ev, tone-mapped, encoded, rounded to nearest.
DisplayPicture tone_map(const Picture& picture, float exposure_ev, ToneMap map = ToneMap::neutral);

}  // namespace opaline::runtime
