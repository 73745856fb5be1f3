#pragma once

#include "formats/opal/rgb.h"
#include "runtime/clouds/layer_light.h"

namespace opaline::runtime {

/// Albedo of the ground at (x, z), a mean over `footprint` [m]. Beyond the picture it repeats with
/// the layer, or keeps its edge.
formats::Rgb ground_albedo(const LayerLight& light, double x, double z, double footprint);

/// Radiance of the ground at (x, z), the same in all directions: albedo / pi (sum over suns of E
/// mu_l (T_0 + T_1) + RG). x, z finite [m]. `footprint`: what is averaged over [m], >= 0.
formats::Rgb see_ground(const LayerLight& light, double x, double z, double footprint);

/// Color through `distance` [m] of the record's haze, which has the sky's radiance near the
/// horizon; `share` of a view that the color covers, by band.
formats::Rgb haze_over(const LayerLight& light, formats::Rgb color, double distance,
                       formats::Rgb share = {1, 1, 1});

}  // namespace opaline::runtime
