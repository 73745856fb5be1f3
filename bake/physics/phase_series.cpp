#include "bake/physics/phase_series.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/phase.h"

namespace opaline::bake {

namespace {

using formats::PhaseFunction;

using std::numbers::pi;

/// Adds weight * P_l(cosine) to sum[l] for every l.
void add_legendre(double cosine, double weight, std::vector<double>& sum) {
    double last = 0, now = 1;  // (l + 1) P_{l+1} = (2 l + 1) x P_l - l P_{l-1}
    for (std::size_t l = 0; l < sum.size(); ++l) {
        sum[l] += weight * now;
        const auto degree = static_cast<double>(l);
        const double next = ((2 * degree + 1) * cosine * now - degree * last) / (degree + 1);
        last = now;
        now = next;
    }
}

double sum_of_squares(const std::vector<double>& lambda) {
    double sum = 0;
    for (std::size_t l = 0; l < lambda.size(); ++l) {
        sum += static_cast<double>(2 * l + 1) * lambda[l] * lambda[l];
    }
    return sum;
}

/// `square` is the integral of p^2 over the cosine: all degrees together are 8 pi^2 times it.
PhaseSeries finish(std::vector<double> lambda, double square) {
    const double total = 8 * pi * pi * square;
    const double tail = std::max(0.0, total - sum_of_squares(lambda));
    return {std::move(lambda), tail};
}

PhaseSeries expand_gaussian(const PhaseDensity& density, unsigned degrees) {
    // As a function of the angle the integrand is smooth for any width of the lobe. P_l adds l / 2
    // oscillations.
    const GaussLegendre rule = make_gauss_legendre(96 + static_cast<int>(degrees));
    const double end = std::min(pi, 8 * static_cast<double>(density.function.rms_angle));
    std::vector<double> lambda(degrees, 0.0);
    double square = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double cosine = std::cos(end * rule.node[i]);
        const double p = eval_phase(density, cosine);
        const double weight = end * rule.weight[i] * std::sin(end * rule.node[i]) * p;
        add_legendre(cosine, 2 * pi * weight, lambda);
        square += weight * p;
    }
    return finish(std::move(lambda), square);
}

PhaseSeries expand_table(const PhaseDensity& density, unsigned degrees) {
    // p P_l has degree l + 1 on a segment, and n nodes are exact up to degree 2 n - 1.
    const GaussLegendre rule = make_gauss_legendre(static_cast<int>(degrees) / 2 + 1);
    const PhaseFunction& phase = density.function;
    std::vector<double> lambda(degrees, 0.0);
    double square = 0;
    for (std::size_t row = 1; row < phase.cosine.size(); ++row) {
        const double from = phase.cosine[row - 1], to = phase.cosine[row], width = to - from;
        const double p = density.scale * static_cast<double>(phase.value[row - 1]);
        const double q = density.scale * static_cast<double>(phase.value[row]);
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double t = rule.node[i];
            add_legendre(from + t * width, 2 * pi * width * rule.weight[i] * (p + t * (q - p)),
                         lambda);
        }
        square += width * (p * p + p * q + q * q) / 3;
    }
    return finish(std::move(lambda), square);
}

/// sum of (2 l + 1) lambda_l^2 over what the first `terms` harmonics leave out.
double dropped(const PhaseSeries& series, unsigned terms) {
    double sum = series.tail;
    unsigned left = terms;
    for (std::size_t l = 0; l < series.lambda.size(); ++l) {
        const unsigned orders = 2 * static_cast<unsigned>(l) + 1;
        const unsigned kept = std::min(left, orders);
        left -= kept;
        sum += (orders - kept) * series.lambda[l] * series.lambda[l];
    }
    assert(left == 0);
    return sum;
}

}  // namespace

PhaseSeries expand_henyey_greenstein(double g, unsigned degrees) {
    PhaseSeries series;
    const double q = g * g;
    double power = 1;
    for (unsigned l = 0; l < degrees; ++l, power *= g) {
        series.lambda.push_back(power);
    }
    // sum over l >= n of (2 l + 1) q^l; power is g^n.
    series.tail = power * power * ((2.0 * degrees + 1) / (1 - q) + 2 * q / ((1 - q) * (1 - q)));
    return series;
}

PhaseSeries expand_phase(const PhaseFunction& phase, unsigned degrees) {
    assert(degrees > 0);
    switch (phase.type) {
        case PhaseFunction::Type::henyey_greenstein:
            return expand_henyey_greenstein(static_cast<double>(phase.g), degrees);
        case PhaseFunction::Type::gaussian:
            return expand_gaussian(make_phase_density(phase), degrees);
        case PhaseFunction::Type::tabulated:
            return expand_table(make_phase_density(phase), degrees);
        case PhaseFunction::Type::isotropic:
        case PhaseFunction::Type::rayleigh:
            break;
    }
    PhaseSeries series;
    series.lambda.assign(degrees, 0.0);
    series.lambda[0] = 1;
    if (phase.type == PhaseFunction::Type::rayleigh) {
        constexpr double kSecond = 0.1;  // 1 + x^2 = 4/3 P_0 + 2/3 P_2
        if (degrees > 2) {
            series.lambda[2] = kSecond;
        } else {
            series.tail = 5 * kSecond * kSecond;
        }
    }
    return series;
}

double phase_rms_relative(const PhaseSeries& series, unsigned terms) {
    return std::sqrt(dropped(series, terms) / (series.tail + sum_of_squares(series.lambda)));
}

double phase_rms(const PhaseSeries& series, unsigned terms) {
    return std::sqrt(dropped(series, terms)) / (4 * pi);
}

unsigned choose_phase_terms(const PhaseSeries& series, double tolerance) {
    constexpr unsigned kMostDegrees = 5;
    assert(series.lambda.size() >= kMostDegrees);
    for (unsigned degrees = 1; degrees < kMostDegrees; ++degrees) {
        if (phase_rms_relative(series, degrees * degrees) <= tolerance) return degrees * degrees;
    }
    return kMostDegrees * kMostDegrees;
}

}  // namespace opaline::bake
