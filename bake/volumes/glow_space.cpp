#include "bake/volumes/glow_space.h"

#include <algorithm>
#include <cmath>

#include "bake/volumes/grid_loops.h"

namespace opaline::bake {
std::vector<GlowingGrid> make_glowing_grids(const formats::Scene& scene,
                                            const std::vector<std::uint32_t>& volumes) {
    std::vector<GlowingGrid> grids;
    for (const std::uint32_t v : volumes) {
        const formats::Volume& volume = scene.volumes[v];
        GlowingGrid own;
        own.grid = &volume.emission;
        own.volume = v;
        place_cells(volume.emission, volume.density.to_scene, own);
        for_each_point(glm::ivec3(0), own.extent, [&](glm::ivec3 cell) {
            float most = 0;
            for_each_voxel_of_cell(volume.emission, own.first_cell + cell, [&](glm::vec3 v) {
                most = std::max({most, v.x, v.y, v.z});
            });
            own.bound.push_back(most);
        });
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
