#pragma once

#include <vector>

#include "bake/slab/slab_medium.h"

namespace opaline::bake {

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
