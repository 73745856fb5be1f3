#pragma once

#include "formats/scene.h"

namespace opaline::formats {

/// The mean cosine between propagation directions, 2 pi int mu p(mu) dmu over [-1, 1], which
/// relates sigma_s' = (1 - g) sigma_s. The Gaussian is p ~ exp(-theta^2 / rms_angle^2).
/// Precondition: the phase function is within the bounds of formats/scene.h; a tabulated one is
/// linear between its rows and integrates to 1 over the sphere.
double mean_cosine(const PhaseFunction& phase);

}  // namespace opaline::formats
