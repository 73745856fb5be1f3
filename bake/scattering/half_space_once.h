#pragma once

namespace opaline::bake {

/// Reflectance of a half space under uniform light by exactly one isotropic scattering event, per
/// albedo, as a share of the incident flux; `eta` in [1/3, 3]. By quadrature, with the Jacobian of
/// refraction (README.md, "Half space").
double half_space_once(double eta);

}  // namespace opaline::bake
