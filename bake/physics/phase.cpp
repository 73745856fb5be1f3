#include "bake/physics/phase.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
namespace {

using formats::PhaseFunction;
using std::numbers::pi;

// (e^(ell lambda) - 1) e^-ell without overflow.
double scattered_moment(double lambda, double ell) {
    return lambda < 0 ? std::exp(-ell) * std::expm1(ell * lambda)
                      : -std::exp(-ell * (1 - lambda)) * std::expm1(-ell * lambda);
}

// ln p but for a constant: of a narrow Gaussian p itself is 0 in double where its powers are not.
double log_phase(const PhaseDensity& density, double angle) {
    const PhaseFunction& phase = density.function;
    if (phase.type == PhaseFunction::Type::gaussian) {
        const double x = angle / static_cast<double>(phase.rms_angle);
        return -x * x;
    }
    return std::log(eval_phase(density, std::cos(angle)));
}

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

double scattered_share(double absorption, double ell) {
    return std::exp(-absorption) * -std::expm1(-ell);
}

double moment_after_many(double lambda, double ell) {
    return ell > 0 ? scattered_moment(lambda, ell) / -std::expm1(-ell) : lambda;
}

double moment_of_ray(double lambda, double ell) {
    return lambda * scattered_moment(lambda, ell);
}

double moment_of_source(double lambda, double ell) {
    return lambda * lambda * std::exp(-ell * (1 - lambda));
}

double eval_zonal(std::span<const double> moment, double cosine) {
    double sum = 0, before = 0, legendre = 1;
    for (std::size_t l = 0; l < moment.size(); ++l) {
        const auto degree = static_cast<double>(l);
        sum += (2 * degree + 1) * moment[l] * legendre;
        const double next = ((2 * degree + 1) * cosine * legendre - degree * before) / (degree + 1);
        before = legendre;
        legendre = next;
    }
    return sum / (4 * std::numbers::pi);
}

std::vector<double> power_moments(const PhaseFunction& phase, double ell, unsigned degrees) {
    assert(degrees > 0 && ell >= 0);
    const PhaseDensity density = make_phase_density(phase);
    const double power = ell > 1e-8 ? -std::expm1(-ell) / ell : 1 - ell / 2;
    // Beyond 8 widths of a Gaussian its weight is below 1e-27. In the angle the integrand is smooth
    // for any width of a peak; P_l adds l / 2 oscillations.
    const double end =
        phase.type == PhaseFunction::Type::gaussian
            ? std::min(pi, 8 * static_cast<double>(phase.rms_angle) / std::sqrt(power))
            : pi;
    const GaussLegendre rule = make_gauss_legendre(128 + static_cast<int>(degrees));
    std::vector<double> exponent;
    exponent.reserve(rule.node.size());
    for (const double node : rule.node) {
        exponent.push_back(power * log_phase(density, end * node));
    }
    const double largest = *std::max_element(exponent.begin(), exponent.end());
    std::vector<double> moment(degrees, 0.0);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double angle = end * rule.node[i], cosine = std::cos(angle);
        const double weight = rule.weight[i] * std::sin(angle) * std::exp(exponent[i] - largest);
        double before = 0, legendre = 1;
        for (unsigned l = 0; l < degrees; ++l) {
            moment[l] += weight * legendre;
            const auto degree = static_cast<double>(l);
            const double next =
                ((2 * degree + 1) * cosine * legendre - degree * before) / (degree + 1);
            before = legendre;
            legendre = next;
        }
    }
    const double integral = moment[0];
    for (double& m : moment) {
        m /= integral;
    }
    return moment;
}

double depth_of_even_power(const PhaseFunction& phase) {
    const PhaseDensity density = make_phase_density(phase);
    constexpr int kAngles = 1024;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int i = 0; i <= kAngles; ++i) {
        const double value = log_phase(density, pi * i / kAngles);
        if (std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    return std::clamp(100 * (high - low), 16.0, 1e6);
}

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
