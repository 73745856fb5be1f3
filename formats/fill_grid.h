#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "formats/sparse_grid.h"

namespace opaline::formats {

/// The grid with the values value(voxel) of the voxels from `low` to `high`, both included, and
/// cubes of `voxel` [m] whose index coordinates begin at the scene's origin. Bricks without a value
/// above 0 are left out. Preconditions: low <= high, values finite and >= 0.
template <class Value>
SparseGrid<float> fill_grid(glm::ivec3 low, glm::ivec3 high, double voxel, Value&& value) {
    using Grid = SparseGrid<float>;
    Grid grid;
    grid.to_scene = glm::dmat4(voxel);
    grid.to_scene[3] = glm::dvec4(0, 0, 0, 1);
    grid.first_brick = Grid::brick_of(low);
    grid.extent = Grid::brick_of(high) - grid.first_brick + 1;
    std::vector<float> brick(Grid::kBrickVoxels);
    glm::ivec3 b;
    for (b.z = 0; b.z < grid.extent.z; ++b.z) {
        for (b.y = 0; b.y < grid.extent.y; ++b.y) {
            for (b.x = 0; b.x < grid.extent.x; ++b.x) {
                for (int i = 0; i < static_cast<int>(Grid::kBrickVoxels); ++i) {
                    const glm::ivec3 at = (grid.first_brick + b) * Grid::kSide +
                                          glm::ivec3(i % Grid::kSide, i / Grid::kSide % Grid::kSide,
                                                     i / (Grid::kSide * Grid::kSide));
                    const bool is_in = glm::all(glm::greaterThanEqual(at, low)) &&
                                       glm::all(glm::lessThanEqual(at, high));
                    brick[static_cast<std::size_t>(i)] =
                        is_in ? static_cast<float>(value(at)) : 0.0f;
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

}  // namespace opaline::formats
