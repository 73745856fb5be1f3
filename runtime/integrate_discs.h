#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/environment.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Adds each disc's radiance integrated over each of the 6 n n texels, integral[3 j + band]
/// [W m^-2]. The total, radiance * disc_solid_angle, is exact. Discs smaller than a texel are dealt
/// out by 1024 points of equal solid angle, each to the texels around it (integrate_discs.h); larger
/// ones by the covered share of each texel (exact
/// inside, 32 x 32 points at the rim).
void integrate_discs(std::span<const formats::DistantDisc> discs, std::uint32_t n,
                     const Rotation& rotation, std::span<double> integral);

/// The same without allocating: `scratch` holds at least 6 n n values.
void integrate_discs(std::span<const formats::DistantDisc> discs, std::uint32_t n,
                     const Rotation& rotation, std::span<double> scratch,
                     std::span<double> integral);

}  // namespace opaline::runtime
