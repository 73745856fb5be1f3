#pragma once

#include <cstdint>

#include "bake/base/context.h"

namespace opaline::bake {

/// Reflectance of a half space under uniform light, as shares of the incident flux.
struct HalfSpaceReflectance {
    double once = 0;  ///< scattered once, without an internal reflection
    double rest = 0;  ///< all other light that leaves again
};

/// By a random walk of `paths` paths with the actual albedo, phase function (Henyey-Greenstein) and
/// boundary (README.md, "Energy match"). `albedo` in [0, 1], |g| <= 0.99, `eta` in
/// [1/3, 3]. The same for any number of threads. Standard error about 0.3 / sqrt(paths).
HalfSpaceReflectance walk_half_space(double albedo, double g, double eta, std::uint32_t paths,
                                     std::uint64_t seed, const Context& context);

}  // namespace opaline::bake
