#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Light times each spherical harmonic: entry k is the light vector of Y_k L, whose integral over
/// texel j is that of L times Y_k(direction of the texel's centre), k < `count`. Products with the
/// visibility V of a node give the moments of the light that reaches it, <V, Y_k L>. `integral`:
/// of L over each texel (texel_integrals.h) of a cube map of n x n. The light's discs are part of
/// its texels already, so that they err by up to half a texel. `count`: 0 or a number of harmonics
/// (spherical_harmonics.h). Same bits for any number of threads (0: all cores).
std::vector<LightVector> make_moment_lights(std::span<const double> integral, std::uint32_t n,
                                            std::uint32_t count, unsigned threads = 0);

}  // namespace opaline::runtime
