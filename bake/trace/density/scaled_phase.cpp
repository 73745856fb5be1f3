#include "bake/trace/density/scaled_phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/physics/path_integral/turn.h"
#include "bake/physics/phase_series.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kMoments = 2 * TurnRule::kMost;

// c[0] + c[1] x + ...
using Polynomial = std::vector<double>;

double eval(const Polynomial& p, double x) {
    double value = 0;
    for (std::size_t i = p.size(); i-- > 0;) {
        value = value * x + p[i];
    }
    return value;
}

Polynomial multiply(const Polynomial& a, const Polynomial& b) {
    Polynomial product(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            product[i + j] += a[i] * b[j];
        }
    }
    return product;
}

// int x^k p(x) dx of the measure with the Legendre moments lambda: Legendre's recursion,
// (2 l + 1) x P_l = (l + 1) P_(l+1) + l P_(l-1), applied k times to the moments.
std::array<double, kMoments> power_moments(std::span<const double, kMoments> lambda) {
    std::array<double, kMoments> power{}, now{};
    std::ranges::copy(lambda, now.begin());
    for (std::size_t k = 0; k < kMoments; ++k) {
        power[k] = now[0];
        const std::array<double, kMoments> before = now;
        for (std::size_t l = 0; l + k + 1 < kMoments; ++l) {
            const auto order = static_cast<double>(l);
            now[l] = ((order + 1) * before[l + 1] + (l > 0 ? order * before[l - 1] : 0)) /
                     (2 * order + 1);
        }
    }
    return power;
}

// The root between two places where the polynomial has different signs.
double find_root(const Polynomial& p, double low, double high) {
    const bool rises = eval(p, high) > 0;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        ((eval(p, middle) > 0) == rises ? high : low) = middle;
    }
    return (low + high) / 2;
}

// Roots of a polynomial of degree n, those of the one before between them; fewer if not all are
// within [-1, 1].
std::vector<double> find_roots(const Polynomial& p, const std::vector<double>& before) {
    std::vector<double> ends{-1};
    ends.insert(ends.end(), before.begin(), before.end());
    ends.push_back(1);
    std::vector<double> roots;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (eval(p, ends[i]) * eval(p, ends[i + 1]) > 0) break;
        roots.push_back(find_root(p, ends[i], ends[i + 1]));
    }
    return roots;
}

constexpr unsigned kDegrees = 64;  // looked at, to find the last one that matters
constexpr std::size_t kSteps = 256;

// Coefficients of c^0 ... c^4 of the Legendre polynomials.
constexpr double kLegendre[5][5] = {{1, 0, 0, 0, 0},
                                    {0, 1, 0, 0, 0},
                                    {-0.5, 0, 1.5, 0, 0},
                                    {0, -1.5, 0, 2.5, 0},
                                    {0.375, 0, -3.75, 0, 4.375}};

unsigned last_degree(const PhaseSeries& series) {
    unsigned last = 0;
    for (unsigned l = 1; l < series.lambda.size(); ++l) {
        last = std::abs(series.lambda[l]) > kLeastMoment ? l : last;
    }
    return last;
}

// Empty where p' is negative somewhere.
std::vector<float> make_cumulative(const ScaledPhase& phase) {
    std::vector<double> sum(kSteps + 1, 0.0);
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double middle = -1 + (static_cast<double>(i) + 0.5) * 2 / kSteps;
        const auto p = static_cast<double>(eval_scaled(phase, static_cast<float>(middle)));
        if (p < 0) return {};
        // A floor, so that every cosine may be drawn: p' may touch 0 within a step.
        sum[i + 1] = sum[i] + p + 1e-3;
    }
    std::vector<float> cumulative;
    cumulative.reserve(sum.size());
    for (const double s : sum) {
        cumulative.push_back(static_cast<float>(s / sum.back()));
    }
    cumulative.back() = 1;
    return cumulative;
}

glm::vec3 to_vec3(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

std::array<float, 3> bands(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

// Weighted by density.
glm::vec3 mean_albedo(const formats::Volume& volume) {
    double density = 0;
    glm::dvec3 scattering(0);
    for (std::size_t i = 0; i < volume.density.value.size(); ++i) {
        density += static_cast<double>(volume.density.value[i]);
        scattering += glm::dvec3(volume.scattering.value[i]);
    }
    return density > 0 ? glm::vec3(scattering / density) : glm::vec3(0);
}

}  // namespace

TurnRule make_turn_rule(std::span<const double, kMoments> lambda) {
    const std::array<double, kMoments> moment = power_moments(lambda);
    const auto integrate = [&](const Polynomial& p) {
        double sum = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            sum += p[i] * moment[i];
        }
        return sum;
    };
    // Monic orthogonal polynomials p_n: those of a positive measure have squares above 0, and
    // roots within [-1, 1]; these are the cosines.
    constexpr double kLeastSquare = 1e-9;
    Polynomial last, p{1};
    double last_square = 1;
    std::vector<double> cosine;
    while (cosine.size() < TurnRule::kMost) {
        const double square = integrate(multiply(p, p));
        if (!(square > kLeastSquare)) break;
        Polynomial next = multiply(p, {-integrate(multiply({0, 1}, multiply(p, p))) / square, 1});
        for (std::size_t i = 0; i < last.size(); ++i) {
            next[i] -= square / last_square * last[i];
        }
        std::vector<double> roots = find_roots(next, cosine);
        if (roots.size() <= cosine.size()) break;
        cosine = std::move(roots);
        last = std::exchange(p, std::move(next));
        last_square = square;
    }
    TurnRule rule;
    double sum = 0;
    for (const double own : cosine) {
        // The integral of the polynomial that is 1 here and 0 at the other cosines.
        Polynomial lagrange{1};
        for (const double other : cosine) {
            if (other != own) {
                lagrange = multiply(lagrange, {-other / (own - other), 1 / (own - other)});
            }
        }
        sum += integrate(lagrange);
        rule.cosine[rule.count] = static_cast<float>(own);
        rule.below[rule.count] = static_cast<float>(sum);
        ++rule.count;
    }
    rule.below[rule.count - 1] = 1;
    return rule;
}

ScaledPhase scale_phase(const formats::PhaseFunction& phase) {
    const PhaseSeries series = expand_phase(phase, kDegrees);
    ScaledPhase scaled;
    scaled.degree = std::min(last_degree(series), ScaledPhase::kHighestDegree);
    const bool is_cut = last_degree(series) > scaled.degree;
    scaled.lambda[0] = 1;
    if (is_cut) {
        const ForwardSplit split = split_forward_peak(series, scaled.degree);
        scaled.peak = split.share;
        std::copy(split.rest.lambda.begin(), split.rest.lambda.begin() + scaled.degree + 1,
                  scaled.lambda.begin());
    } else {
        std::copy(series.lambda.begin(), series.lambda.begin() + scaled.degree + 1,
                  scaled.lambda.begin());
    }
    for (unsigned l = 0; l <= scaled.degree; ++l) {
        const double weight = (2 * l + 1) / (4 * std::numbers::pi) * scaled.lambda[l];
        for (std::size_t i = 0; i < scaled.monomial.size(); ++i) {
            scaled.monomial[i] += static_cast<float>(weight * kLegendre[l][i]);
        }
    }
    scaled.cumulative = make_cumulative(scaled);
    if (scaled.cumulative.empty()) {
        // Of p' as if it had one degree more, which the peak takes as far as it is positive.
        std::array<double, 2 * TurnRule::kMost> lambda{};
        std::ranges::copy(scaled.lambda, lambda.begin());
        lambda.back() = std::min(series.lambda[lambda.size() - 1], 0.0);
        scaled.rule = make_turn_rule(lambda);
    }
    return scaled;
}

SampledCosine sample_scaled(const ScaledPhase& phase, float u) {
    const TurnRule& rule = phase.rule;
    if (rule.count > 0) {
        std::size_t i = 0;
        while (i + 1 < rule.count && u >= rule.below[i]) {
            ++i;
        }
        return {rule.cosine[i], 1};
    }
    const std::vector<float>& sum = phase.cumulative;
    const auto above = std::upper_bound(sum.begin() + 1, sum.end() - 1, u);
    const auto step = static_cast<std::size_t>(above - sum.begin()) - 1;
    const float share = sum[step + 1] - sum[step];
    constexpr float kWidth = 2.0f / static_cast<float>(kSteps);
    const float within = share > 0 ? std::clamp((u - sum[step]) / share, 0.0f, 1.0f) : 0.5f;
    SampledCosine sampled;
    sampled.cosine = std::min(1.0f, -1 + (static_cast<float>(step) + within) * kWidth);
    // Density over the sphere: share / (2 pi width).
    sampled.weight = share > 0 ? eval_scaled(phase, sampled.cosine) * 2 *
                                     std::numbers::pi_v<float> * kWidth / share
                               : 0.0f;
    return sampled;
}

ScaledMedium scale_medium(const formats::Volume& volume, double peak) {
    const glm::vec3 sigma_t = to_vec3(volume.sigma_t), albedo = to_vec3(volume.albedo);
    const auto f = static_cast<float>(peak);
    if (volume.scattering.empty() || f == 0) {
        return {bands(sigma_t * (1.0f - f * albedo)),
                bands(albedo * (1 - f) / (1.0f - f * albedo))};
    }
    const glm::vec3 left = 1.0f - f * mean_albedo(volume);
    auto grids = std::make_shared<ScaledGrids>();
    grids->density = volume.density;
    grids->scattering = volume.scattering;
    glm::vec3 largest(0);
    for (std::size_t i = 0; i < volume.density.value.size(); ++i) {
        const float density = volume.density.value[i];
        if (!(density > 0)) continue;
        const glm::vec3 own = glm::min(volume.scattering.value[i] / density, albedo);
        const glm::vec3 share = (1.0f - f * own) / left;
        const float scale = (share.x + share.y + share.z) / 3;
        const glm::vec3 scaled = glm::clamp(1.0f - (1.0f - own) / (left * scale), 0.0f, 1.0f);
        grids->density.value[i] = density * scale;
        grids->scattering.value[i] = density * scale * scaled;
        largest = glm::max(largest, scaled);
    }
    return {bands(sigma_t * left), bands(largest), std::move(grids)};
}

}  // namespace opaline::bake
