#include "bake/reference/phase_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

using formats::PhaseFunction;

// 2 pi int_0^pi exp(-(angle / rms)^2) sin(angle) dangle, by Simpson's rule where the integrand
// exceeds 1e-28.
double integrate_gaussian(double rms_angle) {
    constexpr int kIntervals = 2000;
    const double end = std::min(std::numbers::pi, 8 * rms_angle), step = end / kIntervals;
    const auto f = [&](int i) {
        const double angle = i * step, x = angle / rms_angle;
        return std::exp(-x * x) * std::sin(angle);
    };
    double sum = f(0) + f(kIntervals);
    for (int i = 1; i < kIntervals; ++i) {
        sum += (i % 2 == 1 ? 4 : 2) * f(i);
    }
    return 2 * std::numbers::pi * sum * step / 3;
}

}  // namespace

PhaseSampler make_phase_sampler(const PhaseFunction& function) {
    PhaseSampler sampler{function, 1, {}};
    if (function.type == PhaseFunction::Type::gaussian) {
        sampler.scale = 1 / integrate_gaussian(double{function.rms_angle});
    } else if (function.type == PhaseFunction::Type::tabulated) {
        sampler.cumulative.push_back(0);
        for (std::size_t i = 1; i < function.cosine.size(); ++i) {
            const double width = double{function.cosine[i]} - double{function.cosine[i - 1]};
            const double mean = 0.5 * (double{function.value[i]} + double{function.value[i - 1]});
            sampler.cumulative.push_back(sampler.cumulative.back() +
                                         2 * std::numbers::pi * width * mean);
        }
        sampler.scale = 1 / sampler.cumulative.back();
        for (double& c : sampler.cumulative) {
            c *= sampler.scale;
        }
    }
    return sampler;
}

float pdf_phase(const PhaseSampler& sampler, float cosine) {
    const PhaseFunction& phase = sampler.function;
    const double c = std::clamp(double{cosine}, -1.0, 1.0);
    double p = 1 / (4 * std::numbers::pi);
    switch (phase.type) {
        case PhaseFunction::Type::isotropic:
            break;
        case PhaseFunction::Type::henyey_greenstein: {
            const double g = double{phase.g};
            p *= (1 - g * g) / std::pow((1 - g) * (1 - g) + 2 * g * (1 - c), 1.5);
            break;
        }
        case PhaseFunction::Type::rayleigh:
            p *= 0.75 * (1 + c * c);
            break;
        case PhaseFunction::Type::gaussian: {
            const double x = std::acos(c) / double{phase.rms_angle};
            p = sampler.scale * std::exp(-x * x);
            break;
        }
        case PhaseFunction::Type::tabulated: {
            std::size_t i = 1;
            while (i + 1 < phase.cosine.size() && double{phase.cosine[i]} < c) {
                ++i;
            }
            const double a = double{phase.cosine[i - 1]}, b = double{phase.cosine[i]};
            const double t = (c - a) / (b - a);
            p = sampler.scale * ((1 - t) * double{phase.value[i - 1]} + t * double{phase.value[i]});
            break;
        }
    }
    return static_cast<float>(p);
}

namespace phase_sampler_details {

float cosine_of(double angle) {
    return static_cast<float>(std::cos(angle));
}

float invert_henyey_greenstein(double g, double u) {
    if (std::abs(g) < 1e-4) {
        // The closed form divides by g; to first order p = (1 + 3 g cos) / (4 pi).
        const double c = 1 - 2 * u;
        return static_cast<float>(std::clamp(-c + 1.5 * g * (1 - c * c), -1.0, 1.0));
    }
    const double s = (1 - g * g) / (1 - g + 2 * g * u);
    return static_cast<float>(std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0));
}

float invert_rayleigh(double u) {
    // c^3 + 3 c = 8 u - 4, by Cardano's formula.
    const double q = 4 * u - 2, r = std::cbrt(q + std::sqrt(q * q + 1));
    return static_cast<float>(std::clamp(r - 1 / r, -1.0, 1.0));
}

GaussianCandidate propose_gaussian(double rms_angle, double u) {
    // angle * exp(-(angle / rms)^2) is sampled by inversion; sin(angle) / angle is the probability
    // of acceptance.
    const double angle = rms_angle * std::sqrt(-std::log(1 - u));
    if (angle >= std::numbers::pi) {
        return {};
    }
    return {angle, angle > 0 ? std::sin(angle) / angle : 1};
}

float invert_table(const PhaseSampler& sampler, double u) {
    const auto& cumulative = sampler.cumulative;
    const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
    const auto i = static_cast<std::size_t>(above - cumulative.begin());
    const PhaseFunction& phase = sampler.function;
    const double a = double{phase.cosine[i - 1]}, width = double{phase.cosine[i]} - a;
    const double p = double{phase.value[i - 1]}, q = double{phase.value[i]};
    // The fraction x of the interval with p x + (q - p) x^2 / 2 = area; stable for p = q and p = 0.
    const double area = (u - cumulative[i - 1]) / (2 * std::numbers::pi * sampler.scale * width);
    const double root = std::sqrt(std::max(0.0, p * p + 2 * (q - p) * area));
    const double x = p + root > 0 ? 2 * area / (p + root) : 0.0;
    return static_cast<float>(std::clamp(a + width * std::clamp(x, 0.0, 1.0), -1.0, 1.0));
}

}  // namespace phase_sampler_details
}  // namespace opaline::bake
