#pragma once

namespace opaline::bake {

// Light of irradiance E, on a plane facing it, that leaves a slab after one or two scatterings. Its
// radiance is E times a density [1/sr], which integrates to 1 over the sphere, times a factor:
// p(cos) for once, p * p (cos) for twice (`convolve_with_itself` of bake/physics/mie). cos is that
// between propagation directions; [Bouthors2006] has 4 pi for the 1 and -dot(l, v) for cos. All
// functions: optical depth along the normal, >= 0; cosines to the normal of light and view in [0,
// 1], below 1e-12 taken for that. Derivations: README.md, "Once and twice". Never NaN; relative
// error 1e-13 where not underflown.

/// Once, on the side of the light and on the other: exact.
double reflected_once(double depth, double light, double view);
double transmitted_once(double depth, double light, double view);

/// Twice, if one of both scatterings turns the light from one path to the other, and the other
/// happens anywhere along that folded path: 10 to 25 % off, less for peaked phase functions.
double reflected_twice(double depth, double light, double view);
double transmitted_twice(double depth, double light, double view);

/// Radiance of the orders of three and more over that of a diffuse surface of the same flux:
/// w(mu) = (1 - exp(-a / mu)) / (1 - 2 E_3(a)), 2 int w mu dmu = 1. 1 / (2 mu) where a = 0, 1 where
/// a is large; a = (1 - g) depth in reflection and depth / 2 in transmission come near to thick and
/// thin layers. a >= 0; `view` as above.
double spread_profile(double a, double view);

}  // namespace opaline::bake
