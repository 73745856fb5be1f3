#pragma once

#include <span>

#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// A layer along one ray, taken as a thin sheet where it is seen on average: what is nearer stands
/// before all of it, what is farther behind all of it. Exact for what does not overlap the layer in
/// depth; continuous for what moves through it.
struct LayerSheet {
    formats::Rgb radiance;                ///< its own light, without glow [W m^-2 sr^-1]
    formats::Rgb transmittance{1, 1, 1};  ///< exp(-tau_S), of what is behind
    float distance = 0;                   ///< from the eye [m]; 0 where the ray meets no layer

    bool is_met() const { return transmittance.g < 1; }
};

/// The sheet that several rays through a pixel see: means, of distances by what each takes of the
/// light behind it (green). Precondition: at least one.
LayerSheet mean_sheet(std::span<const LayerSheet> sheets);

}  // namespace opaline::runtime
