#pragma once

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

}  // namespace opaline::bake
