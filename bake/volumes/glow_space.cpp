#include "bake/volumes/glow_space.h"

#include <algorithm>
#include <cmath>

#include "bake/volumes/density_space.h"

namespace opaline::bake {
namespace {

using ColorGrid = formats::SparseGrid<glm::vec3>;

// The largest channel among the voxels 8 b .. 8 b + 8.
float largest_in_cell(const ColorGrid& grid, glm::ivec3 cell) {
    float most = 0;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 above(c & 1, c >> 1 & 1, c >> 2);
        const std::uint32_t number = grid.brick_at(cell + above);
        if (number == ColorGrid::kEmpty) {
            continue;
        }
        const glm::ivec3 last = (ColorGrid::kSide - 1) * (1 - above);
        const auto value = grid.brick(number);
        for (int z = 0; z <= last.z; ++z) {
            for (int y = 0; y <= last.y; ++y) {
                for (int x = 0; x <= last.x; ++x) {
                    const glm::vec3 v = value[ColorGrid::offset_in_brick({x, y, z})];
                    most = std::max({most, v.x, v.y, v.z});
                }
            }
        }
    }
    return most;
}

}  // namespace

std::vector<GlowingGrid> make_glowing_grids(const formats::Scene& scene,
                                            const std::vector<std::uint32_t>& volumes) {
    std::vector<GlowingGrid> grids;
    for (const std::uint32_t v : volumes) {
        const formats::Volume& volume = scene.volumes[v];
        GlowingGrid own;
        own.grid = &volume.emission;
        own.volume = v;
        const glm::dmat4 to_index = glm::inverse(volume.density.to_scene);
        own.to_index = glm::mat3(to_index);
        own.offset = glm::vec3(to_index[3]);
        own.first_cell = volume.emission.first_brick - 1;
        own.extent = volume.emission.extent + 1;
        glm::ivec3 c;
        for (c.z = 0; c.z < own.extent.z; ++c.z) {
            for (c.y = 0; c.y < own.extent.y; ++c.y) {
                for (c.x = 0; c.x < own.extent.x; ++c.x) {
                    own.bound.push_back(largest_in_cell(volume.emission, own.first_cell + c));
                }
            }
        }
        grids.push_back(std::move(own));
    }
    return grids;
}

glm::vec3 glow_along(const GlowingGrid& glow, glm::vec3 from, glm::vec3 direction, float length) {
    glm::vec3 all(0);
    const float voxels_per_metre = glm::length(glow.to_index * direction);
    visit_cells(glow, from, direction, length, [&](float, float begin, float end) {
        const float steps = std::max(std::ceil((end - begin) * voxels_per_metre), 1.0f);
        const float ds = (end - begin) / steps;
        glm::vec3 sum(0);
        for (float i = 0; i < steps; ++i) {
            const glm::vec3 at = from + (begin + (i + 0.5f) * ds) * direction;
            sum += glow.grid->sample(glow.to_index * at + glow.offset);
        }
        all += ds * sum;
        return true;
    });
    return all;
}

}  // namespace opaline::bake
