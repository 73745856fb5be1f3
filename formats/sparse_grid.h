#pragma once

#include <array>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::formats {

/// Values on a regular lattice, 0 wherever no brick is. Voxel (i, j, k) has its centre at the index
/// coordinates (i, j, k); a brick holds the voxels 8 b .. 8 b + 7 along each axis. T: float, or
/// glm::vec3 for colours.
template <class T>
struct SparseGrid {
    static constexpr int kSide = 8;  ///< voxels along an edge of a brick
    static constexpr std::size_t kBrickVoxels = std::size_t{kSide} * kSide * kSide;
    static constexpr std::uint32_t kEmpty = 0xffffffffu;

    glm::ivec3 first_brick{0};         ///< coordinates b of the lowest corner of the table
    glm::ivec3 extent{0};              ///< bricks along each axis of the table
    std::vector<std::uint32_t> table;  ///< extent.x * extent.y * extent.z numbers of bricks, x
                                       ///< fastest; kEmpty: no brick there
    std::vector<T> value;              ///< 512 per brick, x fastest; finite
    glm::dmat4 to_scene{1};            ///< affine, invertible: index coordinates to the scene [m]

    std::size_t brick_count() const { return value.size() / kBrickVoxels; }
    bool empty() const { return value.empty(); }

    /// The brick with coordinates b; kEmpty where there is none.
    std::uint32_t brick_at(glm::ivec3 b) const {
        const glm::ivec3 p = b - first_brick;
        if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= extent.x || p.y >= extent.y ||
            p.z >= extent.z) {
            return kEmpty;
        }
        return table[(static_cast<std::size_t>(p.z) * static_cast<std::size_t>(extent.y) +
                      static_cast<std::size_t>(p.y)) *
                         static_cast<std::size_t>(extent.x) +
                     static_cast<std::size_t>(p.x)];
    }

    /// The values of a brick. Precondition: brick < brick_count().
    std::span<const T> brick(std::uint32_t number) const {
        return std::span<const T>(value).subspan(number * kBrickVoxels, kBrickVoxels);
    }

    /// Corners [m] of the smallest box along the grid's axes in which every value that is not 0
    /// lies, those between voxels included; empty grids have a box of no size. Looks at all values.
    std::array<glm::dvec3, 8> corners() const {
        glm::ivec3 low(INT_MAX), high(INT_MIN);
        std::size_t cell = 0;
        glm::ivec3 b;
        for (b.z = 0; b.z < extent.z; ++b.z) {
            for (b.y = 0; b.y < extent.y; ++b.y) {
                for (b.x = 0; b.x < extent.x; ++b.x) {
                    const std::uint32_t number = table[cell++];
                    for (int i = 0; number != kEmpty && i < static_cast<int>(kBrickVoxels); ++i) {
                        if (value[number * kBrickVoxels + static_cast<std::size_t>(i)] != T(0)) {
                            const glm::ivec3 at =
                                kSide * (first_brick + b) +
                                glm::ivec3(i % kSide, i / kSide % kSide, i / (kSide * kSide));
                            low = glm::min(low, at);
                            high = glm::max(high, at);
                        }
                    }
                }
            }
        }
        const bool is_empty = low.x > high.x;
        const glm::dvec3 from = is_empty ? glm::dvec3(0) : glm::dvec3(low) - 1.0;
        const glm::dvec3 to = is_empty ? glm::dvec3(0) : glm::dvec3(high) + 1.0;
        std::array<glm::dvec3, 8> corner;
        for (unsigned c = 0; c < 8; ++c) {
            corner[c] =
                glm::dvec3(to_scene * glm::dvec4(c & 1 ? to.x : from.x, c & 2 ? to.y : from.y,
                                                 c & 4 ? to.z : from.z, 1));
        }
        return corner;
    }

    /// The value of a voxel.
    T at(glm::ivec3 voxel) const {
        const std::uint32_t number = brick_at(brick_of(voxel));
        return number == kEmpty ? T(0) : value[number * kBrickVoxels + offset_in_brick(voxel)];
    }

    /// Linear between the centres of the eight voxels around a point in index coordinates, 0 beyond
    /// the grid. Precondition: finite.
    T sample(glm::vec3 index) const {
        const glm::vec3 low = glm::floor(index);
        // Far away there is no voxel, and an int may not hold where it would be.
        constexpr float kFar = 1 << 30;
        if (!(glm::all(glm::lessThan(glm::abs(low), glm::vec3(kFar))))) return T(0);
        const glm::ivec3 base(low);
        const glm::vec3 f = index - low;
        T corner[8];
        const glm::ivec3 inside = base & (kSide - 1);
        if (inside.x < kSide - 1 && inside.y < kSide - 1 && inside.z < kSide - 1) {
            const std::uint32_t number = brick_at(brick_of(base));
            if (number == kEmpty) return T(0);
            const T* const v = value.data() + number * kBrickVoxels + offset_in_brick(base);
            constexpr int kRow = kSide, kSlice = kSide * kSide;
            for (int c = 0; c < 8; ++c) {
                corner[c] = v[(c & 1) + (c >> 1 & 1) * kRow + (c >> 2) * kSlice];
            }
        } else {
            for (int c = 0; c < 8; ++c) {
                corner[c] = at(base + glm::ivec3(c & 1, c >> 1 & 1, c >> 2));
            }
        }
        for (int c = 0; c < 4; ++c) {
            corner[c] = corner[2 * c] + (corner[2 * c + 1] - corner[2 * c]) * f.x;
        }
        for (int c = 0; c < 2; ++c) {
            corner[c] = corner[2 * c] + (corner[2 * c + 1] - corner[2 * c]) * f.y;
        }
        return corner[0] + (corner[1] - corner[0]) * f.z;
    }

    static glm::ivec3 brick_of(glm::ivec3 voxel) {
        return {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
    }
    static std::size_t offset_in_brick(glm::ivec3 voxel) {
        const glm::ivec3 p = voxel & (kSide - 1);
        const int offset = (p.z * kSide + p.y) * kSide + p.x;
        return static_cast<std::size_t>(offset);
    }
};

}  // namespace opaline::formats
