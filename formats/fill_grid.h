#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "formats/sparse_grid.h"

namespace opaline::formats {

/// Calls visit(b) for all b from `low` to before low + extent, x fastest.
template <class Visit>
void for_bricks(glm::ivec3 low, glm::ivec3 extent, Visit&& visit) {
    glm::ivec3 b;
    for (b.z = 0; b.z < extent.z; ++b.z) {
        for (b.y = 0; b.y < extent.y; ++b.y) {
            for (b.x = 0; b.x < extent.x; ++b.x) {
                visit(low + b);
            }
        }
    }
}

/// The voxel that value `i` of a brick is of.
inline glm::ivec3 voxel_of(glm::ivec3 brick, int i) {
    constexpr int kSide = SparseGrid<float>::kSide;
    return kSide * brick + glm::ivec3(i % kSide, i / kSide % kSide, i / (kSide * kSide));
}

/// Appends a brick to the grid's table, and its values unless all are 0.
template <class T>
void append_brick(const std::vector<T>& values, SparseGrid<T>& grid) {
    const bool is_empty =
        std::all_of(values.begin(), values.end(), [](const T& value) { return value == T(0); });
    grid.table.push_back(is_empty ? SparseGrid<T>::kEmpty
                                  : static_cast<std::uint32_t>(grid.brick_count()));
    if (!is_empty) grid.value.insert(grid.value.end(), values.begin(), values.end());
}

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
    std::vector<float> values(Grid::kBrickVoxels);
    for_bricks(grid.first_brick, grid.extent, [&](glm::ivec3 brick) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::ivec3 at = voxel_of(brick, static_cast<int>(i));
            const bool is_in =
                glm::all(glm::greaterThanEqual(at, low)) && glm::all(glm::lessThanEqual(at, high));
            values[i] = is_in ? static_cast<float>(value(at)) : 0.0f;
        }
        append_brick(values, grid);
    });
    return grid;
}

}  // namespace opaline::formats
