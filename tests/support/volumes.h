#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "formats/scene.h"

namespace opaline::tests {

/// A grid whose voxels have the value density(position of their centre [m]), over a box about the
/// scene's origin. `voxel` [m]. Bricks without a value are left out.
template <class Density>
formats::SparseGrid<float> sample_grid(glm::dvec3 half_size, double voxel, Density&& density) {
    using Grid = formats::SparseGrid<float>;
    Grid grid;
    grid.to_scene = glm::dmat4(voxel);
    grid.to_scene[3] = glm::dvec4(0, 0, 0, 1);
    const glm::ivec3 low(glm::floor(-half_size / voxel)), high(glm::ceil(half_size / voxel));
    grid.first_brick = Grid::brick_of(low);
    grid.extent = Grid::brick_of(high) - grid.first_brick + 1;
    glm::ivec3 b;
    for (b.z = 0; b.z < grid.extent.z; ++b.z) {
        for (b.y = 0; b.y < grid.extent.y; ++b.y) {
            for (b.x = 0; b.x < grid.extent.x; ++b.x) {
                std::vector<float> brick;
                for (int i = 0; i < static_cast<int>(Grid::kBrickVoxels); ++i) {
                    const glm::ivec3 voxel_in(i % Grid::kSide, i / Grid::kSide % Grid::kSide,
                                              i / (Grid::kSide * Grid::kSide));
                    const glm::ivec3 at = (grid.first_brick + b) * Grid::kSide + voxel_in;
                    brick.push_back(static_cast<float>(density(voxel * glm::dvec3(at))));
                }
                const bool is_empty = *std::max_element(brick.begin(), brick.end()) <= 0;
                grid.table.push_back(is_empty ? Grid::kEmpty
                                              : static_cast<std::uint32_t>(grid.brick_count()));
                if (!is_empty) {
                    grid.value.insert(grid.value.end(), brick.begin(), brick.end());
                }
            }
        }
    }
    return grid;
}

/// exp(-r^2 / (2 size^2)), cut to zero at 4 sizes.
inline formats::SparseGrid<float> make_blob(double size, double voxel) {
    return sample_grid(glm::dvec3(4 * size), voxel, [size](glm::dvec3 p) {
        const double square = glm::dot(p, p) / (size * size);
        return square > 16 ? 0.0 : std::exp(-0.5 * square);
    });
}

/// 1 inside a ball; at its surface the share of the voxel inside, of a plane's.
inline formats::SparseGrid<float> make_ball_grid(double radius, double voxel) {
    return sample_grid(glm::dvec3(radius + voxel), voxel, [=](glm::dvec3 p) {
        return std::clamp(0.5 + (radius - glm::length(p)) / voxel, 0.0, 1.0);
    });
}

inline formats::Volume make_volume(formats::SparseGrid<float> density, float sigma_t, float albedo,
                                   float g) {
    formats::Volume volume;
    volume.name = "volume";
    volume.density = std::move(density);
    volume.sigma_t = {sigma_t, sigma_t, sigma_t};
    volume.albedo = {albedo, albedo, albedo};
    volume.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    volume.phase.g = g;
    return volume;
}

}  // namespace opaline::tests
