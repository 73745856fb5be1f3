#pragma once

#include <map>
#include <string>
#include <vector>

namespace opaline::tests {

/// One parameter of a hard case, and errors along it.
struct ErrorCurve {
    std::string title, axis;
    struct Point {
        double at = 0, naive = 0, ours = 0;
        std::string exact;  ///< a line of exact.tsv
    };
    std::vector<Point> points;  ///< along the axis, which is logarithmic
};

/// Optical depth, albedo to 1, index to 1, mean cosine to 1, size parameter.
std::vector<ErrorCurve> error_curves();

/// errors.svg: a panel a curve, relative errors of the naive form and of ours.
std::string print_error_curves(const std::vector<ErrorCurve>& curves,
                               const std::map<std::string, long double>& exact);

}  // namespace opaline::tests
