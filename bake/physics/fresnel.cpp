#include "bake/physics/fresnel.h"

#include <algorithm>
#include <cmath>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {

double refracted_cosine(double cosine, double eta) {
    return std::sqrt(std::max(0.0, 1 - (1 - cosine * cosine) / (eta * eta)));
}

double fresnel_reflectance(double cosine, double eta) {
    return 1 - fresnel_transmittance(cosine, eta);
}

double fresnel_transmittance(double cosine, double eta) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    if (eta == 1) {
        return 1;  // no boundary
    }
    if ((1 - c * c) >= eta * eta) return 0;
    const double t = refracted_cosine(c, eta);
    if (c == 0 || t == 0) return 0;
    // 1 - r^2 of each polarisation: 4 a b / (a + b)^2, a product that does not cancel.
    const double s = 4 * c * eta * t / std::pow(c + eta * t, 2);
    const double p = 4 * eta * c * t / std::pow(eta * c + t, 2);
    return 0.5 * (s + p);
}

namespace {

// int_0^1 F(mu; eta) mu^power dmu.
double reflectance_moment(double eta, int power) {
    static const GaussLegendre rule = make_gauss_legendre(64);
    // Total reflection below the critical cosine is integrated in closed form; mu = m + (1 - m) t^2
    // removes the square-root edge at m. For eta >= 1 the edge is at mu = 0.
    const double m = eta < 1 ? std::sqrt(1 - eta * eta) : 0.0;
    double sum = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double t = rule.node[i], mu = m + (1 - m) * t * t;
        sum +=
            rule.weight[i] * 2 * (1 - m) * t * fresnel_reflectance(mu, eta) * std::pow(mu, power);
    }
    return std::pow(m, power + 1) / (power + 1) + sum;
}

}  // namespace

FresnelMoments fresnel_moments(double eta) {
    if (std::abs(eta - 1) < 1e-9) {
        return {};
    }
    return {reflectance_moment(1 / eta, 1), reflectance_moment(1 / eta, 2),
            2 * reflectance_moment(eta, 1)};
}

double fitted_diffuse_reflectance(double eta) {
    if (eta < 1) return -0.4399 + 0.7099 / eta - 0.3319 / (eta * eta) + 0.0636 / (eta * eta * eta);
    return -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
}

}  // namespace opaline::bake
