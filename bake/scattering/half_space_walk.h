#pragma once

#include <cstdint>

#include "bake/base/context.h"

namespace opaline::bake {

/// Reflectance of a half space under uniform light, as shares of the incident flux.
struct HalfSpaceReflectance {
    double once = 0;  ///< scattered once, without an internal reflection
    double rest = 0;  ///< all other light that leaves again
};

/// What becomes of uniform light on a slab, as shares of the incident flux.
struct SlabShares : HalfSpaceReflectance {
    double through = 0;   ///< scattered, leaves on the far side
    double straight = 0;  ///< enters and leaves, on either side, without having been scattered
};

/// By a random walk of `paths` paths with the actual albedo, phase function (Henyey-Greenstein) and
/// boundary (README.md, "Energy match"). `albedo` in [0, 1], |g| <= 0.99, `eta` in
/// [1/3, 3]. The same for any number of threads. Standard error about 0.3 / sqrt(paths).
HalfSpaceReflectance walk_half_space(double albedo, double g, double eta, std::uint32_t paths,
                                     std::uint64_t seed, const Context& context);

/// The same of a slab with both of its boundaries, `thickness` > 0 mean free paths thick.
SlabShares walk_slab(double albedo, double g, double eta, double thickness, std::uint32_t paths,
                     std::uint64_t seed, const Context& context);

}  // namespace opaline::bake
