#pragma once

#include <cmath>

namespace opaline::bake {

/// Variance per axis [m^2] of the distance between a quasi-path and the paths around it, both end
/// directions given, in a homogeneous medium (README.md, "Spread"):
/// (S / a) (1 - tanh(u) / u), u = (S / 2) sqrt(a b <theta^2> / 2).
/// `scattering` b and `absorption` a [1/m] >= 0; `mean_square_angle` <theta^2> [rad^2] >= 0 of one
/// scattering; `length` S [m] >= 0. Only for phase functions whose square angle is that of a narrow
/// peak: of Henyey-Greenstein functions the tail dominates it, and the spread is far too wide.
inline double bridge_variance(double scattering, double absorption, double mean_square_angle,
                              double length) {
    const double u = 0.5 * length * std::sqrt(0.5 * absorption * scattering * mean_square_angle);
    if (u < 0.05) {
        // 1 - tanh(u) / u cancels, and without absorption S / a is infinite.
        const double q = u * u;
        return scattering * mean_square_angle * length * length * length / 24 *
               (1 - q * (2.0 / 5 - q * (17.0 / 105 - q * (62.0 / 945))));
    }
    return length / absorption * (1 - std::tanh(u) / u);
}

}  // namespace opaline::bake
