#pragma once

#include <array>
#include <cmath>

namespace opaline::formats {

/// CIE 1931 XYZ, of some unit.
using Xyz = std::array<double, 3>;

/// Planck's law over wavelength [nm], in units of 2 h c^2 / nm^5.
inline double planck(double nm, double kelvin) {
    constexpr double kSecond = 1.438777e7;  // [nm K]
    constexpr double kMostExponent = 600;   // beyond, nothing is left
    if (kSecond > kMostExponent * nm * kelvin) return 0;
    return 1.0 / (std::pow(nm, 5) * std::expm1(kSecond / (nm * kelvin)));
}

/// A Gaussian with different widths on both sides.
inline double spectral_lobe(double nm, double mean, double below, double above) {
    const double t = (nm - mean) / (nm < mean ? below : above);
    return std::exp(-0.5 * t * t);
}

/// Colour matching functions of the 1931 observer, multi-lobe fit of [Wyman2013].
inline Xyz color_matching(double nm) {
    return {
        1.056 * spectral_lobe(nm, 599.8, 37.9, 31.0) +
            0.362 * spectral_lobe(nm, 442.0, 16.0, 26.7) -
            0.065 * spectral_lobe(nm, 501.1, 20.4, 26.2),
        0.821 * spectral_lobe(nm, 568.8, 46.9, 40.5) + 0.286 * spectral_lobe(nm, 530.9, 16.3, 31.1),
        1.217 * spectral_lobe(nm, 437.0, 11.8, 36.0) +
            0.681 * spectral_lobe(nm, 459.0, 26.0, 13.8)};
}

/// Linear Rec. 709, white D65; negative for colours that it does not have.
inline std::array<double, 3> rec709_of_xyz(const Xyz& c) {
    return {3.2404542 * c[0] - 1.5371385 * c[1] - 0.4985314 * c[2],
            -0.9692660 * c[0] + 1.8760108 * c[1] + 0.0415560 * c[2],
            0.0556434 * c[0] - 0.2040259 * c[1] + 1.0572252 * c[2]};
}

}  // namespace opaline::formats
