#pragma once

namespace opaline::bake {

/// The exponent of e with which the error of rows by view falls per degree: the norm of the higher
/// degrees of a Henyey-Greenstein function without its forward peak (scaled_phase.h),
///
///     error(L)^2 = sum over l > L of (2 l + 1) lambda'_l^2,
///
/// between the coarsest and the finest truncated rows. Light that was scattered before is smooth,
/// so that errors fall faster. `mean_cosine` in (-1, 1); 0 where degree 1 is all.
double rate_of_degree(double mean_cosine);

}  // namespace opaline::bake
