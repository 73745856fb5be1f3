#include "bake/effects/multiple/walks/exit_lobe.h"

#include <cmath>

#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
namespace {

// Means of functions of the cosine c under F_t c times a weight.
template <class Weight, class Function>
double mean_over_exits(double eta, Weight&& weight, Function&& function) {
    static const GaussLegendre rule = make_gauss_legendre(64);
    double all = 0, sum = 0;
    // Below eta = 1 nothing enters beyond the critical angle; the rule covers the rest.
    const double least = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double c = least + (1 - least) * rule.node[i];
        const double p = rule.weight[i] * c * fresnel_transmittance(c, eta) * weight(c);
        all += p;
        sum += p * function(c);
    }
    return sum / all;
}

double second_legendre(double c) {
    return 1.5 * c * c - 0.5;
}

glm::mat3 outer(glm::vec3 a, glm::vec3 b) {
    return glm::outerProduct(a, b);
}

// Of directions that are spread evenly around the normal but for their mean across it.
ExitDirection around_normal(glm::vec3 n, double c, double c2, double tilt, glm::vec3 across) {
    const auto along = static_cast<float>(c2);
    const glm::vec3 tilted = static_cast<float>(tilt) * across;
    return {static_cast<float>(c) * n + across, 0.5f * (1 - along) * glm::mat3(1.0f) +
                                                    0.5f * (3 * along - 1) * outer(n, n) +
                                                    outer(n, tilted) + outer(tilted, n)};
}

}  // namespace

double extrapolation_length(double eta) {
    const FresnelMoments moments = fresnel_moments(eta);
    return 2.0 / 3 * (1 + 3 * moments.c2) / (1 - 2 * moments.c1);
}

ExitLobe make_exit_lobe(double eta) {
    const auto mean = [&](auto&& function) {
        return mean_over_exits(
            eta, [](double) { return 1.0; }, function);
    };
    ExitLobe lobe;
    lobe.eta = eta;
    lobe.mean = mean([](double c) { return c; });
    lobe.square = mean([](double c) { return c * c; });
    lobe.tilt = mean([](double c) { return c * (1 - c * c); }) / (1 - lobe.square);
    lobe.level = mean(second_legendre);
    lobe.slope = mean([&](double c) { return (c - lobe.mean) * second_legendre(c); }) /
                 (lobe.square - lobe.mean * lobe.mean);
    lobe.bend = mean([&](double c) {
        const double b = second_legendre(c) - lobe.level - lobe.slope * (c - lobe.mean);
        return b * b;
    });
    lobe.tilted = mean([&](double c) { return (c - lobe.tilt) * (c - lobe.tilt) * (1 - c * c); });
    lobe.around = mean([](double c) { return (1 - c * c) * (1 - c * c); });
    const double z = extrapolation_length(eta);
    const auto radiance = [&](double c) { return z + refracted_cosine(c, eta); };
    lobe.diffuse = mean_over_exits(eta, radiance, [](double c) { return c; });
    lobe.diffuse_square = mean_over_exits(eta, radiance, [](double c) { return c * c; });
    return lobe;
}

ExitDirection ExitLobe::direction(glm::vec3 normal, const WalkExit& exit) const {
    if (exit.turned >= 1) {
        // Light inside that drifts has a radiance of 1 + 3 drift . w in proportion; at the boundary
        // it drifts less than on average over the walk, and more after few scatterings (README.md,
        // "The light at an exit").
        constexpr double kDrift = 0.67, kSpread = 0.31;
        const auto turned = static_cast<double>(exit.turned);
        const double few = 1 / (3 * turned * turned);
        const glm::vec3 across = exit.drift - glm::dot(normal, exit.drift) * normal;
        const auto drift =
            static_cast<float>(1.5 * kDrift * (1 + few) / (eta * std::sqrt(eta)) * (1 - square));
        const auto spread = static_cast<float>(kSpread * (1 + 2 * few) / (eta * eta * eta));
        ExitDirection direction =
            around_normal(normal, diffuse, diffuse_square, tilt, drift * across);
        direction.square +=
            spread * (outer(across, across) -
                      0.5f * glm::dot(across, across) * (glm::mat3(1.0f) - outer(normal, normal)));
        return direction;
    }
    if (!(glm::dot(normal, exit.direction) > 0)) {
        return around_normal(normal, mean, square, tilt, glm::vec3(0));
    }
    return {exit.direction, outer(exit.direction, exit.direction)};
}

LightFactor ExitLobe::eval(glm::vec3 normal, glm::vec3 exit) const {
    const glm::dvec3 n(normal), e(exit);
    const double c = glm::dot(n, e);
    if (!(c > 0)) {
        return {};
    }
    const glm::dvec3 t = e - c * n;  // so that t . w is what both have in common across the normal
    const double across = 1 - square, along = (c - mean) / (square - mean * mean);
    const double bent = (second_legendre(c) - level - slope * (c - mean)) / bend;
    const double tilting = 2 * (c - tilt) / tilted, turned = 2 / around;
    LightFactor factor;
    // 1 + along (c - mean) + 2 / across t . w + bent b(c) + tilting (c - tilt) t . w
    //   + turned (2 (t . w)^2 - |t|^2 (1 - c^2)), c = n . w
    factor.constant =
        1 - along * mean - bent * (0.5 + level - slope * mean) - turned * glm::dot(t, t);
    factor.linear = (along - bent * slope) * n + (2 / across - tilting * tilt) * t;
    factor.square = (1.5 * bent + turned * glm::dot(t, t)) * glm::outerProduct(n, n) +
                    tilting * glm::outerProduct(n, t) + 2 * turned * glm::outerProduct(t, t);
    return factor;
}

}  // namespace opaline::bake
