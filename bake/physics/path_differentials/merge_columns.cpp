#include "bake/physics/path_differentials/merge_columns.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

#include "bake/physics/path_differentials/axis_frame.h"

namespace opaline::bake {
namespace {

constexpr int kCoordinates = 6;  // dP: 3 or 2, dD: 2, dlnW
using Moments = Eigen::Matrix<double, kCoordinates, kCoordinates>;
using Coordinates = Eigen::Matrix<double, kCoordinates, 1>;

/// On a surface the third axis of dP is its normal, along which nothing moves.
struct MergeAxes {
    glm::dmat3 position, direction;
    int position_axes;
};

Coordinates to_coordinates(const DifferentialColumn& column, const MergeAxes& axes) {
    Coordinates x = Coordinates::Zero();
    for (int i = 0; i < axes.position_axes; ++i) {
        x[i] = glm::dot(axes.position[i], column.dP);
    }
    x[3] = glm::dot(axes.direction[0], column.dD);
    x[4] = glm::dot(axes.direction[1], column.dD);
    x[5] = column.dlnW;
    return x;
}

DifferentialColumn from_coordinates(const Coordinates& x, const MergeAxes& axes) {
    return {axes.position * glm::dvec3(x[0], x[1], x[2]),
            axes.direction * glm::dvec3(x[3], x[4], 0), x[5], 1};
}

}  // namespace

std::size_t merge_columns(std::span<DifferentialColumn> columns, std::span<const double> steps,
                          const MergeSpace& space) {
    const MergeAxes axes{space.N_g ? frame_around(*space.N_g) : glm::dmat3(1.0),
                         frame_around(space.D), space.N_g ? 2 : 3};
    Moments moments = Moments::Zero();
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const Coordinates x = steps[i] * to_coordinates(columns[i], axes);
        moments += x * x.transpose();
    }
    // Each coordinate in units of its own size: metres, radians and ratios have no common one, and
    // the smallest must not drown.
    const Coordinates size = moments.diagonal().cwiseSqrt();
    const Coordinates inverse = size.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
    const Moments scaled = inverse.asDiagonal() * moments * inverse.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Moments> solver(scaled);
    const double least = 1e-15 * scaled.trace();
    std::size_t count = 0;
    for (int k = kCoordinates - 1; k >= 0 && count < columns.size(); --k) {
        const double eigenvalue = solver.eigenvalues()[k];
        if (!(eigenvalue > least)) break;
        const Coordinates x =
            std::sqrt(eigenvalue) * solver.eigenvectors().col(k).cwiseProduct(size);
        columns[count++] = from_coordinates(x, axes);
    }
    return count;
}

}  // namespace opaline::bake
