#pragma once

#include <cstdint>

#include "formats/opal/environment.h"

namespace opaline::bake {

/// A photographer's studio for translucent statues, 1024 x 512: a large warm key light at the left
/// front, a weak broad fill at the right, two tall cool strips behind, which light thin parts from
/// the back, an overhead panel, a dim backdrop and a darker floor. Radiance at most 15, mean over
/// the sphere about 0.5; every edge is smooth.
formats::Environment make_studio();

/// Clear daylight sky with its sun as a disc, 1024 x 512, after [Preetham1999]: luminance and
/// chromaticity distribution (its appendix), sunlight through its molecules, ozone and aerosol.
/// Below the horizon lies a ground of albedo about 0.2 lit by this sky. Scaled so that a horizontal
/// white diffuse surface has luminance 1. `turbidity` in [1.7, 10], `elevation` of the sun in
/// (0, 90] degrees, `azimuth` in degrees as in direction_of.
formats::Environment make_sky(double turbidity, double elevation, double azimuth);

}  // namespace opaline::bake
