#pragma once

#include <vector>

namespace opaline::bake {

/// What a plane slab is made of: homogeneous.
struct SlabMedium {
    /// Legendre moments of the phase function, as PhaseSeries::lambda: p(cos) =
    /// sum_l (2 l + 1) / (4 pi) moment[l] P_l(cos) integrates to 1 over the sphere, moment[0] = 1,
    /// moment[1] is the mean cosine. Those past the end are 0.
    std::vector<double> moment{1.0};
    double albedo = 1;  ///< share of the extinction that scatters, in [0, 1]
};

}  // namespace opaline::bake
