#include "bake/effects/volumes/coarse_volume.h"

#include <array>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <span>
#include <vector>

#include "formats/fill_grid.h"

namespace opaline::bake {
namespace {

using formats::SparseGrid;

int floor_div(int a, int b) {
    return a / b - (a % b < 0 ? 1 : 0);
}

glm::ivec3 floor_div(glm::ivec3 a, int b) {
    return {floor_div(a.x, b), floor_div(a.y, b), floor_div(a.z, b)};
}

// Means of the voxels of `fine` that joined voxels of a brick consist of.
template <class T>
std::vector<T> means_of_brick(const SparseGrid<T>& fine, glm::ivec3 brick, int joined) {
    constexpr int kSide = SparseGrid<T>::kSide;
    std::vector<T> means(SparseGrid<T>::kBrickVoxels, T(0));
    const float share =
        1 / (static_cast<float>(joined) * static_cast<float>(joined) * static_cast<float>(joined));
    formats::for_bricks(joined * brick, glm::ivec3(joined), [&](glm::ivec3 part) {
        const std::uint32_t number = fine.brick_at(part);
        if (number == SparseGrid<T>::kEmpty) return;
        const std::span<const T> values = fine.brick(number);
        for (int i = 0; i < static_cast<int>(values.size()); ++i) {
            const glm::ivec3 in = floor_div(formats::voxel_of(part, i), joined) - kSide * brick;
            means[SparseGrid<T>::offset_in_brick(in)] +=
                share * values[static_cast<std::size_t>(i)];
        }
    });
    return means;
}

template <class T>
SparseGrid<T> empty_coarse_grid(const SparseGrid<T>& fine, int joined) {
    SparseGrid<T> coarse;
    coarse.first_brick = floor_div(fine.first_brick, joined);
    coarse.extent = floor_div(fine.first_brick + fine.extent - 1, joined) - coarse.first_brick + 1;
    // The middle of a joined voxel is that of its own ones.
    coarse.to_scene = glm::scale(glm::translate(fine.to_scene, glm::dvec3(0.5 * (joined - 1))),
                                 glm::dvec3(joined));
    return coarse;
}

template <class T>
SparseGrid<T> join_grid(const SparseGrid<T>& fine, int joined) {
    if (fine.empty()) return fine;
    SparseGrid<T> coarse = empty_coarse_grid(fine, joined);
    formats::for_bricks(coarse.first_brick, coarse.extent, [&](glm::ivec3 brick) {
        formats::append_brick(means_of_brick(fine, brick, joined), coarse);
    });
    return coarse;
}

// Bricks are those of `density`, whether anything is scattered in them or not.
SparseGrid<glm::vec3> join_scattering(const formats::Volume& volume,
                                      const SparseGrid<float>& density, int joined) {
    SparseGrid<glm::vec3> fine = volume.scattering;
    fine.first_brick = volume.density.first_brick;
    fine.extent = volume.density.extent;
    fine.table = volume.density.table;
    SparseGrid<glm::vec3> coarse{
        density.first_brick, density.extent, density.table, {}, density.to_scene};
    formats::for_bricks(density.first_brick, density.extent, [&](glm::ivec3 brick) {
        if (density.brick_at(brick) == SparseGrid<float>::kEmpty) return;
        const std::vector<glm::vec3> means = means_of_brick(fine, brick, joined);
        coarse.value.insert(coarse.value.end(), means.begin(), means.end());
    });
    return coarse;
}

}  // namespace

std::size_t most_nodes(Quality quality) {
    constexpr std::array<std::size_t, 4> kMost{8000, 32000, 128000, 1000000};
    return kMost[static_cast<std::size_t>(quality)];
}

formats::Volume join_voxels(const formats::Volume& volume, int joined) {
    formats::Volume coarse = volume;
    coarse.density = join_grid(volume.density, joined);
    coarse.emission = join_grid(volume.emission, joined);
    if (!volume.scattering.empty()) {
        coarse.scattering = join_scattering(volume, coarse.density, joined);
    }
    return coarse;
}

}  // namespace opaline::bake
