#include "bake/physics/phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {

namespace {

using formats::PhaseFunction;

using std::numbers::pi;

double gaussian_integral(double rms_angle) {
    // Beyond 8 widths the weight is below 1e-27; within, the integrand is smooth.
    const GaussLegendre rule = make_gauss_legendre(96);
    const double end = std::min(pi, 8 * rms_angle);
    double sum = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double angle = end * rule.node[i], x = angle / rms_angle;
        sum += end * rule.weight[i] * std::exp(-x * x) * std::sin(angle);
    }
    return 2 * pi * sum;
}

/// Near 1: corrects the rounding of the table to single precision.
double table_integral(const PhaseFunction& phase) {
    double sum = 0;
    for (std::size_t i = 1; i < phase.cosine.size(); ++i) {
        const double from = phase.cosine[i - 1], to = phase.cosine[i];
        const double p = phase.value[i - 1], q = phase.value[i];
        sum += (to - from) * (p + q) / 2;
    }
    return 2 * pi * sum;
}

/// Linear in the cosine.
double interpolate(const PhaseFunction& phase, double cosine) {
    const auto above = std::upper_bound(phase.cosine.begin() + 1, phase.cosine.end() - 1,
                                        static_cast<float>(cosine));
    const auto i = static_cast<std::size_t>(above - phase.cosine.begin());
    const double from = phase.cosine[i - 1], to = phase.cosine[i];
    const double p = phase.value[i - 1], q = phase.value[i];
    const double t = std::clamp((cosine - from) / (to - from), 0.0, 1.0);
    return (1 - t) * p + t * q;
}

}  // namespace

double henyey_greenstein(double cosine, double g) {
    // (1 - g)^2 + 2 g (1 - cos) equals 1 + g^2 - 2 g cos and does not cancel.
    const double base = (1 - g) * (1 - g) + 2 * g * (1 - cosine);
    return (1 - g) * (1 + g) / (4 * std::numbers::pi * base * std::sqrt(base));
}

PhaseDensity make_phase_density(const PhaseFunction& phase) {
    double integral = 1;
    if (phase.type == PhaseFunction::Type::gaussian) {
        integral = gaussian_integral(static_cast<double>(phase.rms_angle));
    } else if (phase.type == PhaseFunction::Type::tabulated) {
        integral = table_integral(phase);
    }
    return {phase, 1 / integral};
}

double eval_phase(const PhaseDensity& density, double cosine) {
    const PhaseFunction& phase = density.function;
    switch (phase.type) {
        case PhaseFunction::Type::isotropic:
            break;
        case PhaseFunction::Type::henyey_greenstein:
            return henyey_greenstein(cosine, static_cast<double>(phase.g));
        case PhaseFunction::Type::rayleigh:
            return 3 / (16 * pi) * (1 + cosine * cosine);
        case PhaseFunction::Type::gaussian: {
            const double x =
                std::acos(std::clamp(cosine, -1.0, 1.0)) / static_cast<double>(phase.rms_angle);
            return density.scale * std::exp(-x * x);
        }
        case PhaseFunction::Type::tabulated:
            return density.scale * interpolate(phase, cosine);
    }
    return 1 / (4 * pi);
}

}  // namespace opaline::bake
