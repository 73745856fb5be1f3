#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A quadrature rule on [0, 1]; the weights sum to 1.
struct PathRule {
    std::vector<double> position, weight;
};

/// Gauss-Legendre with `count` >= 1 nodes: exact for polynomials of degree 2 count - 1.
PathRule make_gauss_rule(std::uint32_t count);

/// Midpoints of `count` >= 1 equal intervals, the rule of [Wang2005].
PathRule make_midpoint_rule(std::uint32_t count);

/// Coefficients of a medium for the integral along the inward normal [1/m].
struct PathMedium {
    std::array<double, 3> sigma_s{}, sigma_t{};
    double sigma_m = 0;  ///< extinction of the exponential that distributes the nodes, >= 0
};

/// sigma_m is the smallest extinction of the channels, so that no integrand is singular at the far
/// end of the path (README.md, "Path quadrature"). In `paper` fidelity it is the luminance of the
/// extinction, as in [Wang2005].
PathMedium make_path_medium(const formats::Medium& medium);

/// One point of the inward path.
struct PathNode {
    double depth = 0;                ///< s_i [m], in (0, d_m)
    std::array<double, 3> weight{};  ///< of T_p(s_i) in T^(1), without unit
};

/// Nodes s_i and weights with which, for each channel c (README.md, "Path quadrature"),
///     sum_i weight_i T_p(s_i) ~= int_0^d_m sigma_s T_p(s) e^{-sigma_t s} ds,
/// the rule being applied in xi, s = -log1p(-lambda xi) / sigma_m, lambda = -expm1(-sigma_m d_m).
/// `length`: d_m [m]; infinity is allowed where sigma_m > 0. Not positive or NaN: no nodes.
std::vector<PathNode> place_path_nodes(const PathRule& rule, const PathMedium& medium,
                                       double length);

/// Length [m] of a path without an exit: 40 / smallest extinction, at most `diagonal`, the diagonal
/// of the body's bounding box.
double path_limit(const PathMedium& medium, double diagonal);

}  // namespace opaline::bake
