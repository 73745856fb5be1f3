#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Radiance sum_k c_k Y_k(w) [W m^-2 sr^-1], w in the light's frame, of degrees 0, 1 and 2: Y_k as
/// in formats/opal/spherical_harmonics.h. Negative where the expansion rings.
using Harmonics = std::array<formats::Rgb, 9>;

/// Adds the integral over each of the 6 n n texels, integral[3 j + band] [W m^-2], to 1e-5 of the
/// largest. `threads` 0: all cores; the result has the same bits for any number. Never allocates on
/// one thread.
void integrate_harmonics(const Harmonics& harmonics, std::uint32_t n, const Rotation& rotation,
                         unsigned threads, std::span<double> integral);

/// The radiance as a cube map of 32 x 32 texels a face, in the light's frame, negative values as 0.
formats::Environment sample_harmonics(const Harmonics& harmonics);

}  // namespace opaline::runtime
