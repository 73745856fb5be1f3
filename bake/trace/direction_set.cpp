#include "bake/trace/direction_set.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

glm::vec3 to_glm(formats::Vec3 v) {
    return {v.x, v.y, v.z};
}

// `fine`: cells along a face, n or 2 n. With n, rays pass through quarter `quarter` of each texel,
// or through its centre.
constexpr std::uint32_t kCentre = 4;
DirectionSet make_set(std::uint32_t n, std::uint32_t fine, std::uint32_t quarter) {
    DirectionSet set;
    set.cubemap_size = n;
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (const double omega : solid_angle) {
            set.inverse_solid_angle.push_back(static_cast<float>(1.0 / omega));
        }
    }
    const std::vector<formats::Vec3> moments = formats::texel_moments(fine);
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t row = 0; row < fine; row += 4) {
            for (std::uint32_t column = 0; column < fine; column += 4) {
                DirectionBlock block{};
                glm::vec3 sum(0);
                for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
                    const std::uint32_t i = row + lane / 4, j = column + lane % 4;
                    const glm::vec3 d =
                        to_glm(quarter < kCentre
                                   ? formats::texel_direction(2 * n, face, 2 * i + quarter / 2,
                                                              2 * j + quarter % 2)
                                   : formats::texel_direction(fine, face, i, j));
                    const formats::Vec3 m = moments[(std::size_t{face} * fine + i) * fine + j];
                    block.dir_x[lane] = d.x, block.dir_y[lane] = d.y, block.dir_z[lane] = d.z;
                    block.moment_x[lane] = m.x;
                    block.moment_y[lane] = m.y;
                    block.moment_z[lane] = m.z;
                    block.texel[lane] = (face * n + i * n / fine) * n + j * n / fine;
                    sum += d;
                }
                block.axis = glm::normalize(sum);
                // The corners of the square are its directions farthest from the axis.
                float smallest = 1;
                for (const std::uint32_t di : {0u, 4u}) {
                    for (const std::uint32_t dj : {0u, 4u}) {
                        const float step = 2.0f / static_cast<float>(fine);
                        const glm::vec3 corner = glm::normalize(to_glm(formats::cube_position(
                            {face, static_cast<float>(column + dj) * step - 1.0f,
                             static_cast<float>(row + di) * step - 1.0f})));
                        smallest = std::min(smallest, glm::dot(corner, block.axis));
                    }
                }
                constexpr float kMargin = 1e-5f;
                block.sine_radius = std::sqrt(1.0f - (smallest - kMargin) * (smallest - kMargin));
                set.blocks.push_back(block);
            }
        }
    }
    return set;
}

}  // namespace

DirectionSet make_direction_set(std::uint32_t n) {
    return make_set(n, 2 * n, kCentre);
}

DirectionSet make_sparse_direction_set(std::uint32_t n, std::uint32_t quarter) {
    return make_set(n, n, quarter);
}

DirectionSet make_texel_directions(std::uint32_t n) {
    return make_set(n, n, kCentre);
}

}  // namespace opaline::bake
