#pragma once

#include <Eigen/Core>
#include <functional>

namespace opaline::bake {

/// A place where the sum of squares is least, found from a start.
struct LeastSquares {
    Eigen::VectorXd parameters;
    double rms = 0;      ///< of the residuals there
    double largest = 0;  ///< of their absolute values
};

/// Levenberg's damped Gauss-Newton steps with difference quotients, at most 200 of them, until a
/// step lowers the sum by less than 1e-12 of itself. Parameters stay within the box. `residuals`
/// must be finite there, and of one length.
LeastSquares minimise_squares(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residuals,
    const Eigen::VectorXd& start, const Eigen::VectorXd& least, const Eigen::VectorXd& most);

}  // namespace opaline::bake
