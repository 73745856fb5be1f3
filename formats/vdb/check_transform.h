#pragma once

#include <cmath>
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

}  // namespace opaline::formats::vdb
