#include "bake/physics/path_quadrature.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
PathRule make_gauss_rule(std::uint32_t count) {
    GaussLegendre rule = make_gauss_legendre(static_cast<int>(count));
    return {std::move(rule.node), std::move(rule.weight)};
}

PathRule make_midpoint_rule(std::uint32_t count) {
    PathRule rule;
    for (std::uint32_t i = 0; i < count; ++i) {
        rule.position.push_back((i + 0.5) / count);
        rule.weight.push_back(1.0 / count);
    }
    return rule;
}

PathMedium make_path_medium(const formats::Medium& medium) {
    const formats::Rgb& s = medium.sigma_s;
    const formats::Rgb& a = medium.sigma_a;
    PathMedium path;
    path.sigma_s = {s.r, s.g, s.b};
    path.sigma_t = {double{s.r} + double{a.r}, double{s.g} + double{a.g},
                    double{s.b} + double{a.b}};
    path.sigma_m =
        medium.fidelity == formats::Medium::Fidelity::paper
            ? 0.2126 * path.sigma_t[0] + 0.7152 * path.sigma_t[1] + 0.0722 * path.sigma_t[2]
            : *std::min_element(path.sigma_t.begin(), path.sigma_t.end());
    return path;
}

std::vector<PathNode> place_path_nodes(const PathRule& rule, const PathMedium& medium,
                                       double length) {
    std::vector<PathNode> nodes;
    const double sigma_m = medium.sigma_m;
    if (!(length > 0) || (std::isinf(length) && !(sigma_m > 0))) return nodes;
    const double lambda = -std::expm1(-sigma_m * length);
    for (std::size_t i = 0; i < rule.position.size(); ++i) {
        // In the limit sigma_m -> 0 the rule applies to s directly; also where the product
        // underflows.
        const bool uniform = !(lambda > 0);
        const double s =
            uniform ? length * rule.position[i] : -std::log1p(-lambda * rule.position[i]) / sigma_m;
        PathNode node{s, {}};
        for (std::size_t c = 0; c < 3; ++c) {
            const double span = uniform ? length : lambda / sigma_m;
            node.weight[c] = rule.weight[i] * span * medium.sigma_s[c] *
                             std::exp(-(medium.sigma_t[c] - (uniform ? 0.0 : sigma_m)) * s);
        }
        nodes.push_back(node);
    }
    return nodes;
}

double path_limit(const PathMedium& medium, double diagonal) {
    const double smallest = *std::min_element(medium.sigma_t.begin(), medium.sigma_t.end());
    constexpr double kOpaque = 40;  // e^-40 is below anything a float accumulates
    return smallest > 0 ? std::min(diagonal, kOpaque / smallest) : diagonal;
}

}  // namespace opaline::bake
