#pragma once

#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A phase function by degree: p(cos) = sum_l (2 l + 1) / (4 pi) lambda_l P_l(cos), lambda_0 = 1,
/// lambda_1 the mean cosine (Henyey-Greenstein: lambda_l = g^l). By Funk and Hecke p is diagonal
/// in spherical harmonics: |lambda_l| are its singular values, 2 l + 1 times each, and l their
/// degree. lambda_l may be negative.
struct PhaseSeries {
    std::vector<double> lambda;  ///< degrees 0, 1, ...
    double tail = 0;             ///< sum of (2 l + 1) lambda_l^2 over the degrees left out, >= 0
};

/// The first `degrees` degrees, 1 or more. Exact for Henyey-Greenstein, Rayleigh and isotropic
/// functions; Gauss-Legendre quadrature for Gaussian ones (to 1e-12) and tables (exact for p linear
/// between the rows). Precondition: the phase function is within the bounds of formats/scene.h.
PhaseSeries expand_phase(const formats::PhaseFunction& phase, unsigned degrees);

/// The same for a Henyey-Greenstein function; |g| < 1.
PhaseSeries expand_henyey_greenstein(double g, unsigned degrees);

/// Relative RMS error, over all pairs of directions, of keeping the first `terms` harmonics, degree
/// by degree (README.md, "Phase functions"). `terms` in [0, degrees^2].
double phase_rms_relative(const PhaseSeries& series, unsigned terms);

/// The same error [1/sr], not divided by the RMS of p.
double phase_rms(const PhaseSeries& series, unsigned terms);

/// The smallest of 1, 4, 9, 16 and 25 terms whose relative RMS error is at most `tolerance`;
/// otherwise 25. Other numbers cut a multiplet, and the error would depend on the direction.
/// Precondition: 5 degrees or more.
unsigned choose_phase_terms(const PhaseSeries& series, double tolerance);

}  // namespace opaline::bake
