#pragma once

#include <array>
#include <vector>

#include "bake/physics/phase_series.h"

namespace opaline::bake {

/// What light does between its last flight, from the light to a path, and the eye. `ell`:
/// scattering depth along the path to the last scattering.
enum class PathKernel {
    ray,      ///< free flight from the eye, then one scattering or more, then the last: radiance
    source,   ///< a scattering at the start, any number on the way, then the last: source radiance
    boundary  ///< one scattering or more up to where the path leaves and light enters: radiance
};

/// Legendre moments of a kernel at depth `ell` >= 0, as many as `series` has: those of
/// `moment_of_ray` and `moment_of_source` (phase.h). At ell = 0 those of the source are
/// lambda^2. For `ray` divided by 1 - e^-ell, the chance of a scattering on the path, so that the
/// limit at 0 is finite: lambda^2 again. Not of `boundary`.
std::vector<double> path_moments(PathKernel kernel, const PhaseSeries& series, double ell);

/// Factor by which sums of `path_moments` and a `ZonalRow` are multiplied: 1 - e^-ell, or 1.
double kernel_factor(PathKernel kernel, double ell);

/// A kernel as a function of the cosine between the first direction of a path and the direction to
/// the light, and of ell. Cosines are dense where the phase function has a peak; ell is spaced
/// evenly in log(1 + ell). Interpolation: cubic. Relative error at most 1e-4 for Henyey-Greenstein
/// functions with |g| <= 0.99.
struct ZonalTable {
    static constexpr int kCosines = 96, kDepths = 64;

    PathKernel kernel = PathKernel::source;
    /// Coordinate of a cosine: log((forward + 1 - cosine) / (backward + 1 + cosine)).
    double forward = 1, backward = 1;
    double depth_spacing = 1;  ///< of log(1 + ell) between nodes, > 0
    std::vector<float> value;  ///< [1/sr], kCosines * kDepths, depths fastest
};

/// `kernel`: ray or source. `series` needs as many degrees as its square has: ln(1e-12) / (2 ln g)
/// for Henyey-Greenstein. lambda of degree 1 and above must be below 1.
ZonalTable make_zonal_table(PathKernel kernel, const PhaseSeries& series);

/// The same with directions along paths as [Premoze2003] has them: (12) instead of the exact law
/// (physics/phase.h). `kernel`: ray or boundary. As many degrees as for the exact table.
ZonalTable make_power_table(PathKernel kernel, const formats::PhaseFunction& phase,
                            unsigned degrees);

/// A kernel at one cosine, as a function of ell: what a march needs.
struct ZonalRow {
    PathKernel kernel = PathKernel::source;
    float nodes_per_log = 1;
    std::array<float, ZonalTable::kDepths> value{};  ///< [1/sr]

    /// kappa(cosine, ell) [1/sr], `ell` >= 0, also infinite. Constant beyond the last node, where
    /// the kernel is 1 / (4 pi) but for 1e-6.
    double operator()(double ell) const;
};

/// `cosine` in [-1, 1].
ZonalRow interpolate_row(const ZonalTable& table, double cosine);

}  // namespace opaline::bake
