#pragma once

#include <array>

#include "formats/spectrum.h"

namespace opaline::bake {

using formats::Xyz;

/// Clear sky of [Preetham1999]: per quantity (Y, x, y) Perez's distribution
///   F(theta, gamma) = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma)
/// with coefficients linear in turbidity, scaled to the value at the zenith.
struct PerezSky {
    std::array<std::array<double, 5>, 3> coefficient{};  ///< A..E for Y, x, y
    std::array<double, 3> zenith{};                      ///< Y [kcd/m^2], x, y at the zenith
    std::array<double, 3> zenith_distribution{};         ///< F(0, sun_zenith)
};

/// `turbidity` in [1.7, 10]; `sun_zenith` [rad], in [0, pi/2].
PerezSky make_perez_sky(double turbidity, double sun_zenith);

/// Radiance of the sky, luminance in kcd/m^2. `cos_theta` in [0, 1] is the height of the view
/// direction, `gamma` [rad] its angle from the sun. Finite; components may be slightly negative.
Xyz eval_perez_sky(const PerezSky& sky, double cos_theta, double gamma);

/// Irradiance of the sun on a plane facing it, illuminance in klx: a black body of 5778 K giving
/// 128 klx outside the atmosphere, dimmed along the relative optical mass by molecules, aerosol
/// (Angstrom's formula with the turbidity's coefficient, exponent 1.3) and 0.35 cm of ozone, the
/// transmittances that [Preetham1999] gives in its appendix. Water vapour and mixed gases are left
/// out, because they absorb beyond 680 nm, where the colour matching functions almost vanish. The
/// colour matching functions are the analytic fit of [Wyman2013].
Xyz sun_irradiance(double turbidity, double sun_zenith);

}  // namespace opaline::bake
