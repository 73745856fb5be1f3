#pragma once

#include "formats/opal/rgb.h"

namespace opaline::formats {

/// Radiance of a black body at `kelvin`, weighted with the eye's response and in linear Rec. 709:
/// its luminance [cd/m^2] is 683 lm/W times the integral of Planck's law times y over 360 to 830
/// nm, so that it agrees with light from glTF, which is in nits. Channels below 0 (blue, below 1900
/// K) are 0. To a hundredth, the accuracy of the matching functions [Wyman2013]. Precondition: 0 <=
/// kelvin, finite; 0 is black.
Rgb black_body_radiance(double kelvin);

}  // namespace opaline::formats
