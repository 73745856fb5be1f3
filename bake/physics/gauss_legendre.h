#pragma once

#include <vector>

namespace opaline::bake {

/// Gauss-Legendre quadrature on [0, 1]: exact for polynomials of degree 2 n - 1.
struct GaussLegendre {
    std::vector<double> node;    ///< ascending, in (0, 1)
    std::vector<double> weight;  ///< > 0, sum 1
};

/// `n` at least 1.
GaussLegendre make_gauss_legendre(int n);

}  // namespace opaline::bake
