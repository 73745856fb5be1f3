#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Sixteen neighbouring cells, 4 x 4: subtexels of 2 x 2 texels, or whole texels.
struct DirectionBlock {
    RayPacket::Lane dir_x, dir_y, dir_z;                ///< unit, through the cell
    RayPacket::Lane moment_x, moment_y, moment_z;       ///< integral of w over the cell [sr]
    std::array<std::uint32_t, RayPacket::kSize> texel;  ///< of the cube map
    glm::vec3 axis;                                     ///< unit
    float sine_radius;  ///< sine of its angular radius, with a margin for rounding
};

/// The directions of a cube map, one or 2 x 2 per texel, in blocks that make coherent ray packets.
struct DirectionSet {
    std::uint32_t cubemap_size = 0;
    std::vector<DirectionBlock> blocks;      ///< 6 (n/2)^2, or 6 (n/4)^2 with one ray a texel
    std::vector<float> inverse_solid_angle;  ///< 1 / dOmega_j [1/sr] of each texel, 6 n n
};

/// 2 x 2 rays a texel, through the centres of its quarters. `n`: power of two, at least 8.
DirectionSet make_direction_set(std::uint32_t n);
/// One ray per texel, through the centre of its quarter `quarter` in 0 ... 3. Neighbouring samples
/// alternate quarters, so that the errors at texel edges average out.
DirectionSet make_sparse_direction_set(std::uint32_t n, std::uint32_t quarter);
/// One ray per texel, through its centre.
DirectionSet make_texel_directions(std::uint32_t n);

}  // namespace opaline::bake
