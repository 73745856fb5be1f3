#include "bake/trace/density/scaled_phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/physics/path_integral/forward_split.h"
#include "bake/physics/phase_series.h"

namespace opaline::bake {
namespace {

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
