#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include "bake/physics/slab/slab_medium.h"

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

/// Shares of a beam's flux that leave a slab after exactly one scattering, by cosine of incidence.
struct OnceFluxes {
    std::vector<double> reflected, transmitted;
};

/// In closed form, integrated over views by the rule of as many `streams`: what solve_slab gives as
/// order 1, peak of the phase function included, at a hundredth of its time. One element for each
/// of `depths`, >= 0. `cosines` in [kMinSlabCosine, 1].
std::vector<OnceFluxes> scatter_once(const SlabMedium& medium, std::span<const double> depths,
                                     std::span<const double> cosines, int streams);

/// What is asked of a slab.
struct SlabRequest {
    double optical_depth = 1;    ///< along the normal, in [0, kMaxSlabDepth]
    unsigned halvings = 0;       ///< slabs of half, a quarter ... of the depth that are solved too
    std::vector<double> cosine;  ///< of incidence, in [kMinSlabCosine, 1]
    int streams = 48;            ///< Gauss-Legendre nodes a hemisphere, in [1, kMaxSlabStreams]
    unsigned orders = 0;         ///< scattering orders 0 to `orders` - 1, each by itself
    /// Index of the slab over that of both sides, in [1/3, 3]; other than 1: with smooth boundaries
    /// that reflect and refract by Fresnel's equations. Cosines are those outside.
    double eta = 1;
};
inline constexpr double kMaxSlabDepth = 1e6, kMinSlabCosine = 1e-6;
inline constexpr int kMaxSlabStreams = 512;
inline constexpr unsigned kMaxSlabOrders = 256;

/// Shares of the incident flux that leave the slab.
struct SlabFluxes {
    std::vector<double> reflectance, transmittance;  ///< of a beam, by SlabRequest::cosine
    double mean_reflectance = 0;                     ///< of even light over the hemisphere
    double mean_transmittance = 0;
};

/// One slab. What scatters never is transmitted, or reflected by a boundary: it is in `total` and
/// is order 0.
struct SlabSolution {
    double optical_depth = 0;
    SlabFluxes total;
    std::vector<SlabFluxes> order;  ///< [n]: after exactly n scatterings
};

/// Adding and doubling [vandeHulst1980] (README.md): the slabs of depth optical_depth / 2^j, j = 0
/// to `halvings`. Of a phase function with more than 2 `streams` moments the peak that they leave
/// goes straight on [Wiscombe1977]; it still counts as an order. Orders come from the discrete
/// Fourier transform over complex albedos, to 1e-10. At albedo 1 reflectance + transmittance = 1 to
/// 1e-11 per unit of depth. Error of the streams: about 1e-4 with 16, 1e-5 with 32; with boundaries
/// of eta > 1, 1e-4 with 48. Precondition: the ranges above and those of SlabMedium.
std::vector<SlabSolution> solve_slab(const SlabMedium& medium, const SlabRequest& request);

}  // namespace opaline::bake
