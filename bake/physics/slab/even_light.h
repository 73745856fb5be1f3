#pragma once

#include "formats/scene.h"

namespace opaline::bake {

/// What a half space returns of uniform light, as shares of the incident flux.
struct HalfSpaceReflectance {
    double once = 0;  ///< scattered once, without an internal reflection
    double rest = 0;  ///< all other light that scattered and leaves again
};

/// What becomes of uniform light on a slab, as shares of the incident flux. Beside these the
/// boundary reflects fresnel_moments(eta).external, and the slab absorbs the rest.
struct SlabShares {
    double back = 0;      ///< scattered, leaves on the side that it came from
    double through = 0;   ///< scattered, leaves on the far side
    double straight = 0;  ///< enters and leaves, on either side, without having been scattered
};

/// Of a slab with two smooth boundaries, `thickness` >= 0 mean free paths thick (at most
/// kMaxSlabDepth count), that scatters by Henyey-Greenstein's phase function, by solve_slab and
/// Beer's law. Error at most 1e-3, of half spaces of g = .99 that absorb less
/// than 1e-6 of an event 2e-3: light goes deeper than kMaxSlabDepth. `albedo` in [0, 1], |g| < 1,
/// `eta` in [1/3, 3].
SlabShares share_even_light(double albedo, double g, double eta, double thickness);

/// The same of a half space: the target of the energy match (physics/README.md).
HalfSpaceReflectance half_space_reflectance(double albedo, double g, double eta);

/// Share of uniform light that a half space of the medium returns: the albedo of the diffuse
/// surface to compare the medium with.
formats::Rgb half_space_albedo(const formats::Medium& medium);

}  // namespace opaline::bake
