#pragma once

#include <array>

#include "bake/scene/sent_share.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Upper bounds under light of radiance 1, over all bands.
struct VolumeBrightness {
    double seen = 0;    ///< share of light that a line loses
    double albedo = 0;  ///< largest
    double once = 0;    ///< light scattered once or more
};

VolumeBrightness brightest(const formats::Volume& volume);

/// An upper bound [1] on the optical depth of any straight line through a volume, by band.
std::array<double, 3> largest_depth(const formats::Volume& volume);

/// An upper bound [1] on the radiance of a surface by light that a volume scatters to it, under
/// light of radiance 1: alpha d times (R / D)^2, at most 1, the largest share of a hemisphere,
/// weighted by its cosines, that a ball of radius R around the volume covers at a distance D of its
/// middle; D is that of the nearest of the boxes of the scene's primitives. 0 without surfaces.
double largest_sent_light(const formats::Scene& scene, const formats::Volume& volume);

/// The share of light that surfaces of a scene send on at most, in any band; 0 without surfaces.
SentShare largest_share_of_surfaces(const formats::Scene& scene);

/// An upper bound [W m^-2 sr^-1] on the emission of a volume along any straight line, over all
/// bands; 0 if it does not glow.
double largest_glow(const formats::Volume& volume);

/// An upper bound [W m^-2 sr^-1] on that light with all its scattering in the volumes of a scene:
/// with s the largest albedo times 1 - e^-tau of all, glow / (1 - s).
double largest_scattered_glow(const formats::Scene& scene, const formats::Volume& volume);

}  // namespace opaline::bake
