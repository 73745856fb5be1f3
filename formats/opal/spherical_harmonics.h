#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/vec3.h"

namespace opaline::formats {

/// Highest number of real spherical harmonics in a file: degrees 0 ... 4.
inline constexpr std::uint32_t kMaxHarmonics = 25;

/// True for 1, 4, 9, 16 and 25: all orders of every degree up to some l. Any other number would cut
/// a multiplet, and the result would depend on the orientation of the axes.
constexpr bool is_harmonic_count(std::uint32_t count) {
    return count == 1 || count == 4 || count == 9 || count == 16 || count == 25;
}

/// Real, orthonormal spherical harmonics of a unit direction: value[k] = Y_lm(w), k = l (l + 1) +
/// m, for value.size() = 1, 4, 9, 16 or 25. Polar axis +Z, azimuth from +X toward +Y, no
/// Condon-Shortley sign: Y_1 = sqrt(3 / (4 pi)) (y, z, x). The integral of Y_k Y_j over the sphere
/// is 1 for k = j and 0 otherwise. formats/README.md lists all of them. Baker and runtime both take
/// them from here, so that signs agree.
void eval_spherical_harmonics(Vec3 w, std::span<float> value);

}  // namespace opaline::formats
