#pragma once

#include <cstddef>
#include <vector>

#include "bake/base/context.h"
#include "bake/slab/slab_medium.h"

namespace opaline::bake {

/// Number of nodes along the axes of a RadianceTable, 2 or more each, and of azimuth modes, 1 or
/// more. The cosines' axis serves light and view.
struct RadianceTableSize {
    std::size_t depths = 32, cosines = 24, modes = 8;
};

/// Radiance of all light that a slab of albedo 1 scattered twice or more, tabulated for a renderer:
/// what is left of it, once single scattering is exact, is smooth. Depths as in SlabTable. Cosine j
/// is s^2 (3 - 2 s) at s = j / (cosines - 1), dense at both ends, but not below kLeastTableCosine.
/// A value is mode m of the reflection factor (SlabRadiance) over (1 - exp(-X_l - X_v)) / (mu_l +
/// mu_v), the shape of it near the horizon; it is symmetric in light and view.
struct RadianceTable {
    RadianceTableSize size;
    /// [((depth * modes + m) * cosines + view) * cosines + light]
    std::vector<float> reflected, transmitted;
};
inline constexpr double kLeastTableCosine = 1e-3;

/// By adding and doubling with as many `streams`; the albedo of `medium` counts as 1. A few
/// seconds of one thread; the same bits for any number of threads. Lacks rows once the context is
/// cancelled. Error of droplets of 7 um without their forward peak, eight modes: 1 % of the RMS
/// radiance of a layer, for light up to 80 degrees from the normal (tests/bench/RESULTS.md).
RadianceTable make_radiance_table(const SlabMedium& medium, RadianceTableSize size = {},
                                  int streams = 24, const Context& context = {});

/// Radiance of light scattered twice or more over that of a beam of irradiance 1 on a plane facing
/// it [1/sr], by linear interpolation: depth >= 0, cosines of light and view in [0, 1], `azimuth`
/// [rad] between the horizontal directions that both propagate in. `transmitted`: on the side away
/// from the light. May be below 0 by the error of the modes.
double eval_radiance_table(const RadianceTable& table, double depth, double light, double view,
                           double azimuth, bool transmitted);

}  // namespace opaline::bake
