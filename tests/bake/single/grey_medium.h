#pragma once

#include <numbers>

#include "bake/physics/path_quadrature.h"

namespace opaline::tests {

inline constexpr double kIsotropic =
    0.25 * std::numbers::inv_pi;  ///< the even phase function [1/sr]

/// One medium for all bands [1/m]; sigma_m: of the sampled distances.
inline bake::PathMedium grey(double sigma_s, double sigma_t, double sigma_m) {
    return {{sigma_s, sigma_s, sigma_s}, {sigma_t, sigma_t, sigma_t}, sigma_m};
}

}  // namespace opaline::tests
