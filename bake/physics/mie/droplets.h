#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::bake {

/// Six significant digits, for messages: 5.5e-07, 20000, nan.
inline std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

/// Droplets whose radii follow a modified gamma distribution [Bouthors2006]:
///   n(r) = N0 / (Gamma(gamma) r_n) (r / r_n)^(gamma - 1) exp(-r / r_n),   int n dr = N0,
/// r_n = effective_radius / (gamma + 2). The larger gamma, the narrower the distribution.
struct DropletDistribution {
    double density = 3e8;            ///< N0, droplets per volume [1/m^3], > 0
    double effective_radius = 7e-6;  ///< <r^3> / <r^2> [m], > 0
    double gamma = 2;                ///< in [0.1, 1e4]
};

inline constexpr double kMinGamma = 0.1, kMaxGamma = 1e4;

/// Errors: `usage`, naming what is out of range (NaN included) and the range.
formats::Status check_droplets(const DropletDistribution& droplets);

/// r_n [m].
double characteristic_radius(const DropletDistribution& droplets);

/// pi <r^2> [m^2].
double mean_geometric_section(const DropletDistribution& droplets);

/// kappa = N0 pi r_e^2 [1/m], as [Bouthors2006] prints it: efficiency 1, and r_e^2 where <r^2>
/// belongs. 25 % above Mie theory for its droplets. Fidelity `paper` alone.
double printed_extinction(const DropletDistribution& droplets);

/// Mass of water per volume, (4/3) pi rho N0 <r^3> [kg/m^3], for rho = 1000 kg/m^3.
double liquid_water_content(const DropletDistribution& droplets);

/// 1 / sqrt(gamma + 4): standard deviation over mean of radii weighted by r^4, as forward
/// scattering weights them. Below kMonodisperse, ripples of equal spheres show in the phase
/// function.
double relative_width(const DropletDistribution& droplets);
inline constexpr double kMonodisperse = 0.05;

/// A radius that stands for an interval: droplets of this size as a share of all.
struct RadiusNode {
    double radius = 0;  ///< [m]
    double share = 0;   ///< int of n / N0 over the interval, by the midpoint rule
};

/// Radii that matter: what lies beyond is below 1e-8 of the scattered intensity in any direction,
/// although light ahead weights radii by r^4.
struct RadiusRange {
    double least = 0, most = 0;  ///< [m]
    /// What equal steps of the width that place_radii gives the radii of most cross-section would
    /// have to cover [m].
    double weighted_length = 0;
};
RadiusRange radius_range(const DropletDistribution& droplets);

/// `count` radii, 2 or more and even, ascending: midpoints of intervals that are the narrower the
/// more geometric cross-section lies at their radius, 20 times as wide where there is next to none.
/// No rule of higher order: efficiencies have resonances narrower than any affordable step, so that
/// the sum is a mean over samples of them.
std::vector<RadiusNode> place_radii(const DropletDistribution& droplets, unsigned count);

}  // namespace opaline::bake
