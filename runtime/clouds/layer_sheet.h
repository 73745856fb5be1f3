#pragma once

#include <span>

#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// A layer along one ray as a thin sheet at its mean visible distance: nearer objects are in front
/// of all of it, farther ones behind all of it. Exact for objects that do not overlap the layer in
/// depth; continuous for objects that move through it.
struct LayerSheet {
    formats::Rgb radiance;                ///< its own light, without glow [W m^-2 sr^-1]
    formats::Rgb transmittance{1, 1, 1};  ///< exp(-tau_S), of light from behind
    float distance = 0;                   ///< from the eye [m]; 0 where the ray meets no layer

    bool is_met() const { return transmittance.g < 1; }
};

/// The sheet that several rays through a pixel see: means, of distances by what each takes of the
/// light behind it (green). Precondition: at least one.
LayerSheet mean_sheet(std::span<const LayerSheet> sheets);

}  // namespace opaline::runtime
