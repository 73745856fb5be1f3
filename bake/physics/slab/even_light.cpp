#include "bake/physics/slab/even_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"
#include "bake/physics/half_space_once.h"
#include "bake/physics/slab/solve_slab.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

constexpr int kEvenStreams = 32;

// What enters and leaves unscattered, on the side that it came from and on the far side.
struct Unscattered {
    double back = 0, through = 0;
};

// Uniform radiance arrives with the density 2 mu; a boundary reflects as much from inside as from
// outside.
Unscattered pass_straight(double eta, double thickness) {
    const GaussLegendre rule = make_gauss_legendre(64);
    const double least = eta < 1 ? std::sqrt((1 - eta) * (1 + eta)) : 0;  // below: total reflection
    Unscattered sum;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        // From the critical cosine transmittance begins as a root.
        const double x = rule.node[i], mu = least + (1 - least) * x * x;
        const double inside = refracted_cosine(mu, eta), passed = fresnel_transmittance(mu, eta);
        const double beer = std::exp(-thickness / inside);
        const double leaving = 4 * mu * (1 - least) * x * rule.weight[i] * passed * passed * beer /
                               (1 - (1 - passed) * (1 - passed) * beer * beer);
        sum.through += leaving;
        sum.back += leaving * (1 - passed) * beer;
    }
    return sum;
}

// One moment more than the streams resolve: the peak of the phase function that they leave.
SlabMedium henyey_greenstein(double albedo, double g) {
    SlabMedium medium{{1}, albedo};
    for (int l = 1; l <= 2 * kEvenStreams; ++l) {
        medium.moment.push_back(medium.moment.back() * g);
    }
    return medium;
}

}  // namespace

SlabShares share_even_light(double albedo, double g, double eta, double thickness) {
    const double depth = std::min(thickness, kMaxSlabDepth);
    SlabRequest request;
    request.optical_depth = depth;
    request.streams = kEvenStreams;
    request.eta = eta;
    const SlabFluxes all = solve_slab(henyey_greenstein(albedo, g), request).front().total;
    const Unscattered straight = pass_straight(eta, depth);
    const double external = fresnel_moments(eta).external;
    return {std::max(0.0, all.mean_reflectance - external - straight.back),
            std::max(0.0, all.mean_transmittance - straight.through),
            straight.back + straight.through};
}

HalfSpaceReflectance half_space_reflectance(double albedo, double g, double eta) {
    const double once = albedo * half_space_once(eta, g);
    return {once, std::max(0.0, share_even_light(albedo, g, eta, kMaxSlabDepth).back - once)};
}

formats::Rgb half_space_albedo(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    const std::array<float, 3> scatters{medium.sigma_s.r, medium.sigma_s.g, medium.sigma_s.b},
        absorbs{medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b};
    std::array<float, 3> albedo{};
    for (std::size_t b = 0; b < 3; ++b) {
        if (!(scatters[b] > 0)) continue;
        if (b > 0 && scatters[b] == scatters[b - 1] && absorbs[b] == absorbs[b - 1]) {
            albedo[b] = albedo[b - 1];
            continue;
        }
        const auto sigma_s = static_cast<double>(scatters[b]);
        albedo[b] = static_cast<float>(
            share_even_light(sigma_s / (sigma_s + static_cast<double>(absorbs[b])), g,
                             static_cast<double>(medium.eta), kMaxSlabDepth)
                .back);
    }
    return {albedo[0], albedo[1], albedo[2]};
}

}  // namespace opaline::bake
