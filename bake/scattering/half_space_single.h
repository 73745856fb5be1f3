#pragma once

namespace opaline::bake {

/// What a half space returns of uniform diffuse light after exactly one isotropic scattering, as a
/// share of the incident flux and per albedo; `eta` in [1/3, 3]. By quadrature, with the Jacobian
/// of refraction (README.md, "Half space").
double half_space_single(double eta);

}  // namespace opaline::bake
