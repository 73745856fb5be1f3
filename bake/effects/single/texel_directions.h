#pragma once

#include <cstdint>

#include "bake/transport/direction_set.h"

namespace opaline::bake {

/// The directions of a cube map like make_direction_set, but one through the centre of each texel.
/// Single scattering is smooth in the light's direction: relit values change by .1-.2 % (n = 32).
/// `n`: power of two, at least 8.
DirectionSet make_texel_directions(std::uint32_t n);

}  // namespace opaline::bake
