#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/visibility/ray_scene.h"

namespace opaline::bake {

/// Sixteen neighbouring subtexels: a 4 x 4 square of the grid with twice the cube map's resolution,
/// hence the 2 x 2 subtexels of 2 x 2 texels.
struct DirectionBlock {
    RayPacket::Lane dir_x, dir_y, dir_z;                ///< unit, through the subtexel's centre
    RayPacket::Lane moment_x, moment_y, moment_z;       ///< integral of w over the subtexel [sr]
    std::array<std::uint32_t, RayPacket::kSize> texel;  ///< of the cube map
    glm::vec3 axis;                                     ///< unit
    float sine_radius;  ///< sine of its angular radius, with a margin for rounding
};

/// The directions of a cube map, 2 x 2 per texel, in blocks that make coherent ray packets.
struct DirectionSet {
    std::uint32_t cubemap_size = 0;
    std::vector<DirectionBlock> blocks;      ///< 6 (n/2)^2
    std::vector<float> inverse_solid_angle;  ///< 1 / dOmega_j [1/sr] of each texel, 6 n n
};

/// `n`: power of two, at least 8.
DirectionSet make_direction_set(std::uint32_t n);

}  // namespace opaline::bake
