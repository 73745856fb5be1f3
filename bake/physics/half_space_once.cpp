#include "bake/physics/half_space_once.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
namespace {

// Henyey-Greenstein's phase function over the isotropic one, in the mean over the azimuth, from a
// direction of cosine `down` to one of cosine `up` on the other side of the plane.
double turn_back(double g, double down, double up) {
    constexpr int kAzimuths = 64;
    if (g == 0) return 1;
    const double sines = std::sqrt((1 - down * down) * (1 - up * up));
    double sum = 0;
    for (int k = 0; k < kAzimuths; ++k) {
        const double cosine =
            sines * std::cos(std::numbers::pi * (k + 0.5) / kAzimuths) - down * up;
        const double square = 1 + g * g - 2 * g * cosine;
        sum += (1 - g * g) / (square * std::sqrt(square));
    }
    return sum / kAzimuths;
}

}  // namespace

double half_space_once(double eta, double g) {
    // On a plane the integral over depth is 1 / (sigma_t (1 + mu_o' / mu_i')); the factors of the
    // isotropic phase function, of both azimuths and of the incident flux multiply to 1.
    GaussLegendre rule = make_gauss_legendre(32);
    if (eta < 1) {
        // Nothing enters below the critical cosine, where the transmittance begins as a root.
        const double least = std::sqrt(1 - eta * eta);
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double x = rule.node[i];
            rule.node[i] = least + (1 - least) * x * x;
            rule.weight[i] *= 2 * (1 - least) * x;
        }
    }
    double sum = 0;
    for (std::size_t o = 0; o < rule.node.size(); ++o) {
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double mu_o = rule.node[o], mu_i = rule.node[i];
            const auto inside = [eta](double mu) {
                return std::sqrt(std::max(0.0, 1 - (1 - mu * mu) / (eta * eta)));
            };
            const double in_o = inside(mu_o), in_i = inside(mu_i);
            if (in_o > 0 && in_i > 0) {
                const double jacobian = mu_i / (eta * eta * in_i);
                sum += rule.weight[o] * rule.weight[i] * mu_o * fresnel_transmittance(mu_o, eta) *
                       fresnel_transmittance(mu_i, eta) * jacobian * turn_back(g, in_i, in_o) /
                       (1 + in_o / in_i);
            }
        }
    }
    return sum;
}

}  // namespace opaline::bake
