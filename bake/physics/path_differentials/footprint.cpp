#include "bake/physics/path_differentials/footprint.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

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

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

glm::dvec2 upper(const glm::dvec2& v) {
    return v.y > 0 || (v.y == 0 && v.x > 0) ? v : -v;
}

/// Those that are not 0, in the upper half plane, by angle.
std::vector<glm::dvec2> sorted_fan(std::span<const glm::dvec2> vectors) {
    std::vector<glm::dvec2> fan;
    fan.reserve(vectors.size());
    for (const glm::dvec2& v : vectors) {
        if (v != glm::dvec2(0)) {
            fan.push_back(upper(v));
        }
    }
    std::sort(fan.begin(), fan.end(),
              [](const glm::dvec2& a, const glm::dvec2& b) { return cross2(a, b) > 0; });
    return fan;
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

double polygon_area(std::span<const glm::dvec2> vectors) {
    double area = 0;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        for (std::size_t j = i + 1; j < vectors.size(); ++j) {
            area += std::abs(cross2(vectors[i], vectors[j]));
        }
    }
    return area;
}

double pair_area(const FootprintPair& pair) {
    return std::abs(cross2(pair.A, pair.B));
}

FootprintPair best_pair(std::span<const glm::dvec2> vectors) {
    const std::vector<glm::dvec2> fan = sorted_fan(vectors);
    const glm::dvec2 sum = std::accumulate(fan.begin(), fan.end(), glm::dvec2(0));
    FootprintPair best{sum, glm::dvec2(0)};
    double most = 0;
    // A is a run of the fan; the rest, the part before it turned round, is the run that follows.
    glm::dvec2 before(0);
    for (std::size_t i = 0; i < fan.size(); before += fan[i], ++i) {
        glm::dvec2 run(0);
        for (std::size_t j = i; j < fan.size(); ++j) {
            run += fan[j];
            const FootprintPair pair{run, sum - run - 2.0 * before};
            if (pair_area(pair) > most) {
                most = pair_area(pair);
                best = pair;
            }
        }
    }
    return best;
}

FootprintPair polygon_pair(std::span<const glm::dvec2> vectors) {
    const FootprintPair pair = best_pair(vectors);
    const double part = pair_area(pair);
    const double scale = part > 0 ? std::sqrt(polygon_area(vectors) / part) : 1;
    return {scale * pair.A, scale * pair.B};
}

FootprintPair rms_pair(std::span<const glm::dvec2> vectors) {
    double xx = 0, xy = 0, yy = 0;
    for (const glm::dvec2& v : vectors) {
        xx += v.x * v.x;
        xy += v.x * v.y;
        yy += v.y * v.y;
    }
    // Half the angle of (xx - yy, 2 xy). The smaller eigenvalue from the determinant, the sum of
    // squares of cross products: a difference would lose the digits of thin footprints.
    double determinant = 0;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        for (std::size_t j = i + 1; j < vectors.size(); ++j) {
            const double area = cross2(vectors[i], vectors[j]);
            determinant += area * area;
        }
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const double larger = 0.5 * (xx + yy + std::hypot(xx - yy, 2 * xy));
    const double smaller = larger > 0 ? determinant / larger : 0;
    const glm::dvec2 e(std::cos(angle), std::sin(angle));
    return {std::sqrt(larger) * e, std::sqrt(smaller) * glm::dvec2(-e.y, e.x)};
}

PairExtent pair_extent(const FootprintPair& pair) {
    const double sum = glm::dot(pair.A, pair.A) + glm::dot(pair.B, pair.B);
    const double difference = glm::dot(pair.A, pair.A) - glm::dot(pair.B, pair.B);
    const double major =
        std::sqrt(0.5 * (sum + std::hypot(difference, 2 * glm::dot(pair.A, pair.B))));
    return {major, major > 0 ? pair_area(pair) / major : 0};
}

}  // namespace opaline::bake
