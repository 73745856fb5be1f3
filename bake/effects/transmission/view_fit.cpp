#include "bake/effects/transmission/view_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/physics/fresnel.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

// Added to the variance of every harmonic over the views. Views fill a narrow cone inside, where
// harmonics are nearly dependent: without it their rows would be many times what their sum is, and
// so would the errors of rows as files store them.
constexpr double kSmoothing = 5e-4;

void eval_harmonics(glm::vec3 w, std::span<double> value) {
    std::array<float, formats::kMaxHarmonics> floats{};
    formats::eval_spherical_harmonics({w.x, w.y, w.z}, std::span(floats).first(value.size()));
    std::copy_n(floats.begin(), value.size(), value.begin());
}

// A symmetric positive definite matrix, row by row, as its Cholesky factor.
void factorise(std::span<double> a, std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = j; i < n; ++i) {
            double sum = a[i * n + j];
            for (std::size_t k = 0; k < j; ++k) {
                sum -= a[i * n + k] * a[j * n + k];
            }
            a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
        }
    }
}

void solve(std::span<const double> factor, std::span<double> x) {
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            x[i] -= factor[i * n + k] * x[k];
        }
        x[i] /= factor[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) {
            x[i] -= factor[k * n + i] * x[k];
        }
        x[i] /= factor[i * n + i];
    }
}

// Harmonics without their mean over a set of views, and the factor of their smoothed covariance.
struct Harmonics {
    std::size_t terms = 1;
    std::vector<double> value;   // view by view
    std::vector<double> mean;    // of each
    std::vector<double> factor;  // (terms - 1)^2

    std::span<double> of(std::size_t view) { return std::span(value).subspan(view * terms, terms); }
};

Harmonics centre_harmonics(const TransmissionViews& views, std::uint32_t terms) {
    Harmonics h;
    h.terms = terms;
    h.value.resize(views.seen.size() * terms);
    h.mean.resize(terms);
    for (std::size_t i = 0; i < views.seen.size(); ++i) {
        eval_harmonics(views.seen[i], h.of(i));
        for (std::size_t k = 0; k < terms; ++k) {
            h.mean[k] += views.weight[i] * h.of(i)[k];
        }
    }
    const std::size_t n = terms - 1;
    h.factor.resize(n * n);
    for (std::size_t i = 0; i < views.seen.size(); ++i) {
        for (std::size_t k = 0; k < terms; ++k) {
            h.of(i)[k] -= h.mean[k];
        }
        for (std::size_t j = 0; j < n; ++j) {
            for (std::size_t k = 0; k <= j; ++k) {
                h.factor[j * n + k] += views.weight[i] * h.of(i)[j + 1] * h.of(i)[k + 1];
            }
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        h.factor[k * n + k] += kSmoothing;
    }
    factorise(h.factor, n);
    return h;
}

}  // namespace

TransmissionViews spread_views(glm::vec3 normal, double eta, std::uint32_t count, glm::vec2 shift) {
    const Frame frame = make_frame(normal);
    const double golden = std::numbers::phi - 1;
    TransmissionViews views;
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double c = std::sqrt(1 - (i + static_cast<double>(shift.x)) / count);
        const double weight = fresnel_transmittance(c, eta);
        if (!(weight > 0)) continue;
        const double inside = refracted_cosine(c, eta), sine = std::sqrt(1 - inside * inside);
        const double turn = i * golden + static_cast<double>(shift.y);
        const double azimuth = 2 * std::numbers::pi * (turn - std::floor(turn));
        views.seen.push_back(glm::normalize(frame.to_world(
            glm::vec3(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), inside)))));
        views.weight.push_back(weight);
        sum += weight;
    }
    for (double& weight : views.weight) {
        weight /= sum;
    }
    return views;
}

void leave_out(TransmissionViews& views, std::span<const std::uint32_t> some) {
    double left = 1;
    for (const std::uint32_t i : some) {
        left -= views.weight[i];
        views.weight[i] = 0;
    }
    constexpr double kRounding = 1e-9;
    for (double& weight : views.weight) {
        weight = left > kRounding ? weight / left : 0;
    }
}

std::vector<float> fit_views(const TransmissionViews& views, std::uint32_t terms) {
    std::vector<float> factors;
    factors.reserve(views.seen.size() * terms);
    if (terms == 1) {
        factors.assign(views.weight.begin(), views.weight.end());
        return factors;
    }
    Harmonics h = centre_harmonics(views, terms);
    const double first = 0.5 * std::numbers::inv_sqrtpi;
    std::vector<double> rows(terms - 1);
    for (std::size_t i = 0; i < views.seen.size(); ++i) {
        for (std::size_t k = 1; k < terms; ++k) {
            rows[k - 1] = views.weight[i] * h.of(i)[k];
        }
        solve(h.factor, rows);
        double constant = views.weight[i];
        for (std::size_t k = 1; k < terms; ++k) {
            constant -= rows[k - 1] * h.mean[k];
        }
        factors.push_back(static_cast<float>(constant / first));
        factors.insert(factors.end(), rows.begin(), rows.end());
    }
    return factors;
}

void limit_fit(const TransmissionViews& views, std::uint32_t terms, std::span<const double> even,
               std::span<float> factors) {
    std::vector<double> rows(terms), value(terms);
    double mean = 0, floor = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < even.size(); ++i) {
        floor = views.weight[i] > 0 ? std::min(floor, even[i]) : floor;
        mean += views.weight[i] * even[i];
        for (std::size_t k = 0; k < terms; ++k) {
            rows[k] += static_cast<double>(factors[i * terms + k]) * even[i];
        }
    }
    double darkest = mean;
    for (const glm::vec3& seen : views.seen) {
        eval_harmonics(seen, value);
        double sum = 0;
        for (std::size_t k = 0; k < terms; ++k) {
            sum += rows[k] * value[k];
        }
        darkest = std::min(darkest, sum);
    }
    constexpr double kRounding = 0.01;  // of the mean
    floor = std::min(floor, mean) - kRounding * mean;
    if (darkest >= floor) return;
    const auto scale = static_cast<float>((mean - floor) / (mean - darkest));
    const double first = 0.5 * std::numbers::inv_sqrtpi;
    for (std::size_t i = 0; i < even.size(); ++i) {
        const auto constant = static_cast<float>(views.weight[i] / first);
        float* const own = &factors[i * terms];
        own[0] = constant + scale * (own[0] - constant);
        for (std::size_t k = 1; k < terms; ++k) {
            own[k] *= scale;
        }
    }
}

NonNegativeViews::NonNegativeViews(const TransmissionViews& views, glm::vec3 normal, double eta,
                                   std::uint32_t terms)
    : mean_(terms) {
    std::vector<double> value(terms);
    for (std::size_t i = 0; i < views.seen.size(); ++i) {
        eval_harmonics(views.seen[i], value);
        for (std::size_t k = 0; k < terms; ++k) {
            mean_[k] += views.weight[i] * value[k];
        }
    }
    constexpr std::uint32_t kProbes = 24;
    for (const glm::vec3& seen : spread_views(normal, eta, kProbes, {0.9f, 0}).seen) {
        eval_harmonics(seen, value);
        probe_.insert(probe_.end(), value.begin(), value.end());
    }
}

double NonNegativeViews::apply(float* first, std::size_t stride) const {
    const std::size_t terms = mean_.size();
    const auto sum_with = [&](const double* harmonic) {
        double sum = 0;
        for (std::size_t k = 0; k < terms; ++k) {
            sum += harmonic[k] * static_cast<double>(first[k * stride]);
        }
        return sum;
    };
    const double mean = std::max(0.0, sum_with(mean_.data()));
    double least = mean;
    for (std::size_t i = 0; i < probe_.size(); i += terms) {
        least = std::min(least, sum_with(&probe_[i]));
    }
    if (least >= 0) return mean;
    const auto scale = static_cast<float>(mean / (mean - least));
    const auto constant = static_cast<float>(mean / (0.5 * std::numbers::inv_sqrtpi));
    first[0] = constant + scale * (first[0] - constant);
    for (std::size_t k = 1; k < terms; ++k) {
        first[k * stride] *= scale;
    }
    return mean;
}

ViewKernel::ViewKernel(glm::vec3 normal, double eta, std::uint32_t terms, glm::vec3 seen) {
    if (terms == 1) return;
    constexpr std::uint32_t kViews = 2048;
    Harmonics h = centre_harmonics(spread_views(normal, eta, kViews, {0.5f, 0}), terms);
    std::vector<double> own(terms);
    eval_harmonics(seen, own);
    mean_ = h.mean;
    for (std::size_t k = 1; k < terms; ++k) {
        slope_.push_back(own[k] - mean_[k]);
    }
    solve(h.factor, slope_);
}

double ViewKernel::operator()(glm::vec3 view) const {
    std::vector<double> own(mean_.size());
    double value = 1;
    if (!own.empty()) {
        eval_harmonics(view, own);
    }
    for (std::size_t k = 1; k < own.size(); ++k) {
        value += slope_[k - 1] * (own[k] - mean_[k]);
    }
    return value;
}

}  // namespace opaline::bake
