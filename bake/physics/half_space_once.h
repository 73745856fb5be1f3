#pragma once

namespace opaline::bake {

/// Reflectance of a half space under uniform light by exactly one scattering event, per albedo, as
/// a share of the incident flux; `eta` in [1/3, 3], Henyey-Greenstein's phase function of mean
/// cosine |g| < 1. By quadrature, with the Jacobian of refraction (README.md, "Half space").
double half_space_once(double eta, double g = 0);

}  // namespace opaline::bake
