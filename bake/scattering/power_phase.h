#pragma once

#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Of light that was scattered at least once along a path of scattering depth `ell` >= 0, the
/// Legendre moments that [Premoze2003] (12) gives it: those of p^s / int p^s dw, with
/// s = (1 - e^-ell) / ell. Degrees 0, 1, ..., `degrees` of them, 1 or more. For pictures as in that
/// paper alone; what light does is in poisson_phase.h, and may differ by a factor of 4.
/// Gauss-Legendre quadrature: to 1e-9 of moment 0 where the phase function is smooth, to 1e-3 for
/// tables. Precondition: the phase function is within the bounds of formats/scene.h.
std::vector<double> power_moments(const formats::PhaseFunction& phase, double ell,
                                  unsigned degrees);

/// Depth beyond which p^s is even in all directions but for some 1 %.
double depth_of_even_power(const formats::PhaseFunction& phase);

}  // namespace opaline::bake
