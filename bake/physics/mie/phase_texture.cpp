#include "bake/physics/mie/phase_texture.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

/// 2 pi int of the interpolant over the cosine, d(cosine) = sin(angle) d(angle)/du du.
double integrate_texture(const std::vector<double>& log_value) {
    const GaussLegendre rule = make_gauss_legendre(6);
    const std::size_t last = log_value.size() - 1;
    double sum = 0;
    for (std::size_t i = 0; i < last; ++i) {
        for (std::size_t k = 0; k < rule.node.size(); ++k) {
            const double t = rule.node[k];
            const double u = (static_cast<double>(i) + t) / static_cast<double>(last);
            sum += rule.weight[k] * std::exp(std::lerp(log_value[i], log_value[i + 1], t)) *
                   std::sin(texture_angle(u)) * 6 * pi * u * (1 - u);
        }
    }
    return 2 * pi * sum / static_cast<double>(last);
}

}  // namespace

double texture_angle(double u) {
    return pi * u * u * (3 - 2 * u);
}

double texture_coordinate(double angle) {
    return 0.5 - std::sin(std::asin(std::clamp(1 - 2 * angle / pi, -1.0, 1.0)) / 3);
}

PhaseTexture make_phase_texture(const AngularTable& phase, unsigned texels) {
    assert(texels >= 2);
    std::vector<double> log_value;
    for (unsigned i = 0; i < texels; ++i) {
        const double angle = std::min(pi, texture_angle(i / (texels - 1.0)));
        log_value.push_back(std::log(eval_table(phase, angle)));
    }
    PhaseTexture texture;
    texture.integral = integrate_texture(log_value);
    for (const double value : log_value) {
        texture.log_value.push_back(static_cast<float>(value - std::log(texture.integral)));
    }
    return texture;
}

double eval_texture(const PhaseTexture& texture, double angle) {
    const std::size_t last = texture.log_value.size() - 1;
    const double at = texture_coordinate(angle) * static_cast<double>(last);
    const auto i = std::min(static_cast<std::size_t>(std::max(at, 0.0)), last - 1);
    const double t = at - static_cast<double>(i);
    return std::exp(std::lerp(static_cast<double>(texture.log_value[i]),
                              static_cast<double>(texture.log_value[i + 1]), t));
}

}  // namespace opaline::bake
