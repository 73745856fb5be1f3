#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "formats/sparse_grid.h"

namespace opaline::bake {

/// Calls visit(point) for all integer points with low <= point < high, x fastest.
template <class Visit>
void for_each_point(glm::ivec3 low, glm::ivec3 high, Visit&& visit) {
    glm::ivec3 p;
    for (p.z = low.z; p.z < high.z; ++p.z) {
        for (p.y = low.y; p.y < high.y; ++p.y) {
            for (p.x = low.x; p.x < high.x; ++p.x) {
                visit(p);
            }
        }
    }
}

inline bool is_within(glm::ivec3 extent, glm::ivec3 point) {
    return glm::all(glm::greaterThanEqual(point, glm::ivec3(0))) &&
           glm::all(glm::lessThan(point, extent));
}

/// Of a point of [0, extent), among all in their order.
inline std::size_t number_in(glm::ivec3 extent, glm::ivec3 point) {
    return (static_cast<std::size_t>(point.z) * static_cast<std::size_t>(extent.y) +
            static_cast<std::size_t>(point.y)) *
               static_cast<std::size_t>(extent.x) +
           static_cast<std::size_t>(point.x);
}

/// Corner c of 8 of a unit cube, x fastest.
inline glm::ivec3 corner_of_cube(int c) {
    return {c & 1, c >> 1 & 1, c >> 2};
}

/// Calls visit(value) for the voxels 8 b .. 8 b + 8 of a brick and those above it; once with 0 for
/// a brick that is not there.
template <class T, class Visit>
void for_each_voxel_of_cell(const formats::SparseGrid<T>& grid, glm::ivec3 brick, Visit&& visit) {
    using Bricks = formats::SparseGrid<T>;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 above = corner_of_cube(c);
        const std::uint32_t number = grid.brick_at(brick + above);
        if (number == Bricks::kEmpty) {
            visit(T(0));
            continue;
        }
        for_each_point(
            glm::ivec3(0), Bricks::kSide - (Bricks::kSide - 1) * above,
            [&](glm::ivec3 p) { visit(grid.brick(number)[Bricks::offset_in_brick(p)]); });
    }
}

/// Calls visit(voxel, weight) for voxels less than `reach` from a point of the lattice along each
/// axis; the weight is linear in the distance along each.
template <class Visit>
void for_each_voxel_around(glm::ivec3 point, int reach, Visit&& visit) {
    for_each_point(glm::ivec3(1 - reach), glm::ivec3(reach), [&](glm::ivec3 d) {
        const glm::ivec3 left = reach - glm::abs(d);
        visit(point + d, static_cast<float>(left.x * left.y * left.z));
    });
}

}  // namespace opaline::bake
