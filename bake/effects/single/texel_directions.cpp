#include "bake/effects/single/texel_directions.h"

#include "formats/opal/cubemap.h"

namespace opaline::bake {

DirectionSet make_texel_directions(std::uint32_t n) {
    // The subtexels of a map of half the size are the texels.
    DirectionSet set = make_direction_set(n / 2);
    set.cubemap_size = n;
    set.inverse_solid_angle.clear();
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (const double omega : solid_angle) {
            set.inverse_solid_angle.push_back(static_cast<float>(1.0 / omega));
        }
    }
    std::size_t next = 0;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t row = 0; row < n; row += 4) {
            for (std::uint32_t column = 0; column < n; column += 4) {
                DirectionBlock& block = set.blocks[next++];
                for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
                    block.texel[lane] = (face * n + row + lane / 4) * n + column + lane % 4;
                }
            }
        }
    }
    return set;
}

}  // namespace opaline::bake
