#pragma once

#include <cstdint>

#include "bake/transport/direction_set.h"

namespace opaline::bake {

/// Like make_direction_set, but with one direction through the centre of each texel. Single
/// scattering is smooth in the light's direction: relit values change by 0.1 to 0.2 % (n = 32).
/// `n`: power of two, at least 8.
DirectionSet make_texel_directions(std::uint32_t n);

}  // namespace opaline::bake
