#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace opaline::formats::vdb {

/// Whether a matrix has finite entries, the last row 0 0 0 1 and, each column of the linear part
/// taken with length 1, a determinant that is not 0 but for rounding: whatever the size of a voxel.
inline bool is_invertible_affine(const glm::dmat4& matrix) {
    constexpr double kMinDeterminant = 1e-9;
    glm::dmat3 directions;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(matrix[column][row])) return false;
        }
        if (matrix[column][3] != (column == 3 ? 1.0 : 0.0)) return false;
        if (column < 3) {
            const glm::dvec3 edge(matrix[column]);
            const double length = glm::length(edge);
            if (!(length > 0) || !std::isfinite(length)) return false;
            directions[column] = edge / length;
        }
    }
    return std::abs(glm::determinant(directions)) > kMinDeterminant;
}

/// Limits for untrusted files: far above any volume that can be baked, and low enough that a few
/// hostile bytes cannot exhaust the machine.
inline constexpr std::uint64_t kMaxFileBytes = 16ull << 30;
inline constexpr std::uint32_t kMaxBricks = 1u << 18;       ///< of 8^3 voxels, in all grids that
                                                            ///< are read; 512 MiB of scalars
inline constexpr std::uint32_t kMaxTableBricks = 1u << 24;  ///< entries of the tables of bricks, in
                                                            ///< all grids that are read
/// Largest index coordinate of a voxel, either sign: beyond, a float has no fraction left.
inline constexpr std::int64_t kMaxIndex = 1 << 24;
inline constexpr std::size_t kMaxGrids = 64;           ///< read at once
inline constexpr std::int32_t kMaxGridsInFile = 4096;  ///< listed in a file
inline constexpr std::size_t kMaxNameBytes = 255;      ///< name of a grid
inline constexpr std::size_t kMaxTextBytes = 4096;     ///< a text on its way between processes
inline constexpr std::size_t kMaxTextShown = 200;      ///< bytes of a message about a file
/// Negative values down to this share of a grid's largest value are taken for 0.
inline constexpr float kRoundedToZero = 1e-3f;
/// Voxels that are NaN or more negative, per active voxel, up to which they are set to 0.
inline constexpr double kMaxRepairedShare = 1e-3;

}  // namespace opaline::formats::vdb
