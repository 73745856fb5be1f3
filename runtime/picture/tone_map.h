#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/rgb.h"
#include "runtime/picture/camera.h"
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

/// The camera of the small picture that an exposure is chosen from: the same view, at most 96
/// pixels along a side. The picture is drawn with one sample a pixel, and without the background
/// unless there is a cloud layer, so that objects are exposed whatever stands behind them.
Camera meter_camera(const Camera& camera);

/// Exposure of a picture [EV], from a metered one. With L the geometric mean of the luminance of
/// the brighter half of its pixels that are not black (robust against shadows and highlights): 0
/// for L from 1/64 to 1.5, so that what is lit by some radiance of 1 looks as it is. Brighter ones
/// are shown darker, from 12 up at 0.35; dimmer ones stay dim: they are raised to 1/64, by 10 EV at
/// most. Continuous in L, in steps of 0.01 EV. 0 for a black picture.
float choose_exposure(const Picture& metered);

}  // namespace opaline::runtime
