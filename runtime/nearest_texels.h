#pragma once

#include <array>
#include <cstdint>

#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// A texel and its share of the flux of a small source.
struct TexelShare {
    std::uint32_t texel = 0;
    double share = 0;
};

/// The four texels of 6 n n whose centres are around a direction, with bilinear shares that add up
/// to 1; across the edges of faces too. Light of a small source projected like this is multiplied
/// with the transport interpolated at the source, not with that of the one texel it falls into: it
/// comes from where it is to second order in the texel's size, and moves evenly as it turns.
std::array<TexelShare, 4> nearest_texels(std::uint32_t n, formats::Vec3 direction);

}  // namespace opaline::runtime
