#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace opaline::bake {

/// Albedos on a circle in the complex plane from which the first `orders` coefficients of a power
/// series in the albedo, what scatters that many times, follow by a discrete Fourier transform.
/// Truncation 1e-12 of the order `count()` later; rounding grows to 1e-10.
struct AlbedoCircle {
    explicit AlbedoCircle(unsigned orders)
        : points(std::max(8u, 2 * orders)), radius(std::pow(10.0, -12.0 / points)) {}

    unsigned points;
    double radius;

    /// Of real series only these are needed: the others are conjugates.
    unsigned count() const { return points / 2 + 1; }
    std::complex<double> albedo(unsigned k) const { return std::polar(radius, angle(k)); }
    /// Factor of the value at albedo(k) in the real part that is coefficient n.
    std::complex<double> weight(unsigned k, unsigned n) const {
        const double pair = k == 0 || 2 * k == points ? 1 : 2;
        return std::polar(pair / points * std::pow(radius, -static_cast<double>(n)), -angle(k) * n);
    }

  private:
    double angle(unsigned k) const { return 2 * std::numbers::pi * k / points; }
};

}  // namespace opaline::bake
