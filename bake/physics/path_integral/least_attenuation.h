#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "bake/physics/path_integral/quasi_path.h"

namespace opaline::bake {

/// The curvature alpha [1/rad^2] of a phase function around 0, p ~ p(0) (1 - alpha angle^2), as
/// [Premoze2003] prints it: 1 / (4 (1 - g)), half of what a narrow Gaussian has. `mean_cosine` g in
/// [-1, 1).
inline double printed_curvature(double mean_cosine) {
    return 1 / (4 * (1 - mean_cosine));
}

/// Effective attenuation of a path, [Premoze2003] (7), per ell: int curvature |d beta / d ell|^2
/// d ell + int a ds = curvature angle^2 / ell_total + absorption. `absorption`: of the turn.
inline double effective_attenuation(const QuasiPath& path, double curvature, double absorption) {
    return curvature * path.turn.angle * path.turn.angle / path.ell_total + absorption;
}

/// Of the paths whose turns end at `lengths` times the scattering depth `onward`, the one that is
/// attenuated least until its turn is complete: the search that [Premoze2003] leaves out for its
/// cost (5.1). Where a path leaves the box before, its turn counts as a whole, its absorption as
/// far as it goes. The first one of equals. At least one length, > 0.
template <class Medium>
QuasiPath least_attenuated_path(glm::dvec3 start, const Turn& turn, double onward,
                                std::span<const double> lengths, double curvature,
                                const Medium& medium, const MarchLimits& limits) {
    QuasiPath best;
    double least = std::numeric_limits<double>::infinity();
    for (const double length : lengths) {
        const QuasiPath path{start, turn, std::max(length * onward, kShortestTurn)};
        double absorption = 0;
        march_quasi_path(path, medium, limits, [&](const PathStep& step) {
            absorption = step.absorption;  // to half a step
            return step.ell < path.ell_total;
        });
        if (const double here = effective_attenuation(path, curvature, absorption); here < least) {
            least = here;
            best = path;
        }
    }
    return best;
}

}  // namespace opaline::bake
