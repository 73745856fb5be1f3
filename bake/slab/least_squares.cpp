#include "bake/slab/least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace opaline::bake {

LeastSquares minimise_squares(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residuals,
    const Eigen::VectorXd& start, const Eigen::VectorXd& least, const Eigen::VectorXd& most) {
    constexpr int kMostSteps = 200;
    constexpr double kDifference = 1e-6, kEnough = 1e-12, kMostDamping = 1e12;
    const auto inside = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return x.cwiseMax(least).cwiseMin(most);
    };
    Eigen::VectorXd at = inside(start), value = residuals(at);
    double damping = 1e-3;
    for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
        Eigen::MatrixXd slope(value.size(), at.size());
        for (Eigen::Index i = 0; i < at.size(); ++i) {
            Eigen::VectorXd beside = at;
            const double shift = kDifference * std::max(1.0, std::abs(at[i]));
            beside[i] += beside[i] + shift <= most[i] ? shift : -shift;
            slope.col(i) = (residuals(beside) - value) / (beside[i] - at[i]);
        }
        const Eigen::MatrixXd normal = slope.transpose() * slope;
        const Eigen::VectorXd gradient = slope.transpose() * value;
        const double before = value.squaredNorm();
        double after = before;
        while (after >= before && damping < kMostDamping) {
            Eigen::MatrixXd damped = normal;
            damped.diagonal() += damping * (normal.diagonal().array() + 1e-300).matrix();
            const Eigen::VectorXd next = inside(at - damped.ldlt().solve(gradient));
            const Eigen::VectorXd there = residuals(next);
            after = there.squaredNorm();
            if (after < before) {
                at = next;
                value = there;
                damping /= 10;
            } else {
                damping *= 10;
            }
        }
        if (before - after <= kEnough * before) {
            break;
        }
    }
    return {at, std::sqrt(value.squaredNorm() / static_cast<double>(value.size())),
            value.cwiseAbs().maxCoeff()};
}

}  // namespace opaline::bake
