#pragma once

#include <span>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Henyey-Greenstein phase function [1/sr] [Henyey1941]. `cosine` between propagation
/// directions, in [-1, 1]; |g| < 1.
double henyey_greenstein(double cosine, double g);

/// A phase function that integrates to 1 over the sphere, ready to be evaluated.
struct PhaseDensity {
    formats::PhaseFunction function;
    double scale =
        1;  ///< of the Gaussian's exp(-angle^2 / rms_angle^2) [1/sr], of a table's values
};

/// Precondition: the phase function is within the bounds of formats/scene.h.
PhaseDensity make_phase_density(const formats::PhaseFunction& phase);

/// p(cosine) [1/sr], >= 0. `cosine` between propagation directions, in [-1, 1]: a light direction
/// w_i and a view direction w_o that both point away from the point have cosine = -dot(w_i, w_o).
double eval_phase(const PhaseDensity& density, double cosine);

/// Light along a path in a medium of constant albedo and phase function is scattered a Poisson
/// number of times, with mean `ell` = int b ds [Premoze2003]. What follows is exact for given `ell`
/// [Goudsmit1940], where that paper's equation 12 takes a power of the phase function instead.
/// All need `ell` >= 0 and finite; none overflows or cancels for any such.

/// Share of light that is scattered at least once and not absorbed: e^-absorption (1 - e^-ell),
/// in [0, 1] (Premoze et al., equations 14 and 19). `absorption` = int a ds >= 0.
double scattered_share(double absorption, double ell);

/// Of light that was scattered at least once, the moment of one degree:
/// (e^(ell lambda) - 1) / (e^ell - 1). `lambda` of the phase function, in [-1, 1].
double moment_after_many(double lambda, double ell);

/// lambda (e^(ell lambda) - 1) e^-ell: any number of scatterings but 0 along the path, one more at
/// its end; not divided by their probability.
double moment_of_ray(double lambda, double ell);

/// lambda^2 e^(-ell (1 - lambda)): a scattering at both ends, any number between.
double moment_of_source(double lambda, double ell);

/// Sum over degrees of (2 l + 1) / (4 pi) moment[l] P_l(cosine) [1/sr].
double eval_zonal(std::span<const double> moment, double cosine);

/// Of light that was scattered at least once along a path of scattering depth `ell` >= 0, the
/// Legendre moments that [Premoze2003] (12) gives it: those of p^s / int p^s dw, with
/// s = (1 - e^-ell) / ell. Degrees 0, 1, ..., `degrees` of them, 1 or more. For pictures as in that
/// paper alone; what light does is `moment_after_many`, and may differ by a factor of 4.
/// Gauss-Legendre quadrature: to 1e-9 of moment 0 where the phase function is smooth, to 1e-3 for
/// tables. Precondition: the phase function is within the bounds of formats/scene.h.
std::vector<double> power_moments(const formats::PhaseFunction& phase, double ell,
                                  unsigned degrees);

/// Depth beyond which p^s is even in all directions but for some 1 %.
double depth_of_even_power(const formats::PhaseFunction& phase);

}  // namespace opaline::bake
