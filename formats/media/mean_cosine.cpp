#include "formats/media/mean_cosine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::formats {

namespace {

// Midpoint rule over the angle; beyond 8 widths the weight is below 1e-27.
double gaussian_mean_cosine(double rms_angle) {
    constexpr int kSteps = 4096;
    const double end = std::min(std::numbers::pi, 8.0 * rms_angle);
    double weight = 0, weighted = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double theta = (i + 0.5) * end / kSteps, x = theta / rms_angle;
        const double w = std::exp(-x * x) * std::sin(theta);
        weight += w;
        weighted += w * std::cos(theta);
    }
    return weighted / weight;
}

// Exact for p linear in mu on each segment.
double table_mean_cosine(const PhaseFunction& phase) {
    double sum = 0;
    for (std::size_t i = 1; i < phase.cosine.size(); ++i) {
        const double a = phase.cosine[i - 1], b = phase.cosine[i];
        const double p = phase.value[i - 1], q = phase.value[i];
        sum += (b - a) / 6 * (a * (2 * p + q) + b * (p + 2 * q));
    }
    return 2 * std::numbers::pi * sum;
}

}  // namespace

double mean_cosine(const PhaseFunction& phase) {
    switch (phase.type) {
        case PhaseFunction::Type::henyey_greenstein:
            return static_cast<double>(phase.g);
        case PhaseFunction::Type::gaussian:
            return gaussian_mean_cosine(static_cast<double>(phase.rms_angle));
        case PhaseFunction::Type::tabulated:
            return table_mean_cosine(phase);
        case PhaseFunction::Type::isotropic:
        case PhaseFunction::Type::rayleigh:
            break;
    }
    return 0;
}

}  // namespace opaline::formats
