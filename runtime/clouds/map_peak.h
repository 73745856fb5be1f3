#pragma once

#include <numbers>
#include <optional>

#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// A small light in a map, in the map's frame. Within `kPeakReach` of its brightest pixel,
/// luminance above the threshold belongs to the light, in the pixel's colour.
struct MapPeak {
    formats::Vec3 brightest;  ///< unit
    double threshold = 0;     ///< luminance, >= 0
    formats::Vec3 direction;  ///< unit, centroid of the light
    formats::Rgb irradiance;  ///< on a plane facing it [W m^-2]
    double radius = 0;        ///< of a disc with the same spread [rad]
};

inline constexpr double kPeakReach = 5 * std::numbers::pi / 180;  ///< [rad]

/// The strongest light that stands out of a map. The threshold is four times the mean luminance
/// between 6 and 12 degrees from the brightest pixel, or of the whole map beyond kPeakReach if that
/// is more. There is a light if the brightest pixel has twice the threshold and the light's
/// irradiance is 2 % of that of a hemisphere of the mean luminance, so that a single damaged pixel
/// rarely counts. Up to eight places are compared, more than 12 degrees apart, brightest first.
std::optional<MapPeak> find_peak(const formats::Environment& map);

/// The light's share of a pixel's radiance: luminance above the threshold over luminance.
formats::Rgb above_threshold(formats::Rgb radiance, float threshold);

}  // namespace opaline::runtime
