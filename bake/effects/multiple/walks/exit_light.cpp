#include "bake/effects/multiple/walks/exit_light.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "bake/scattering/fresnel.h"
#include "bake/scattering/gauss_legendre.h"

namespace opaline::bake {
namespace {

using Float4 = float __attribute__((vector_size(16)));

void add_to(float* to, Float4 value) {
    Float4 sum;
    std::memcpy(&sum, to, sizeof sum);
    sum += value;
    std::memcpy(to, &sum, sizeof sum);
}

std::vector<SurfacePoint> sample_points(std::span<const SurfaceSample> samples) {
    std::vector<SurfacePoint> points;
    points.reserve(samples.size());
    for (const SurfaceSample& s : samples) {
        points.push_back({.position = s.position, .normal = s.geometric_normal});
    }
    return points;
}

// Cells twice as wide as samples are apart: the nearest sample lies in one of the 27 around.
float cell_size(std::span<const SurfaceSample> samples) {
    double area = 0;
    for (const SurfaceSample& s : samples) {
        area += static_cast<double>(s.area);
    }
    const double each = samples.empty() ? 0 : area / static_cast<double>(samples.size());
    return each > 0 ? static_cast<float>(1.5 * std::sqrt(each)) : 1.0f;
}

// Moments of a function of the cosine c under p = F_t c / (pi c_exit).
template <class Cosine>
ExitLobe fit_lobe(double eta, Cosine&& cosine) {
    const GaussLegendre rule = make_gauss_legendre(64);
    double sum = 0, first = 0, second = 0;
    // Below eta = 1 nothing enters beyond the critical angle; the rule covers the rest.
    const double least = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double c = least + (1 - least) * rule.node[i];
        const double p = rule.weight[i] * c * fresnel_transmittance(c, eta);
        const double value = cosine(c);
        sum += p;
        first += p * value;
        second += p * value * value;
    }
    ExitLobe lobe;
    lobe.mean = first / sum;
    lobe.variance = second / sum - lobe.mean * lobe.mean;
    lobe.across = 0.5 * (1 - second / sum);
    return lobe;
}

}  // namespace

double extrapolation_length(double eta) {
    const FresnelMoments moments = fresnel_moments(eta);
    return 2.0 / 3 * (1 + 3 * moments.c2) / (1 - 2 * moments.c1);
}

ExitLobe make_exit_lobe(double eta) {
    ExitLobe lobe = fit_lobe(eta, [](double c) { return c; });
    const double z = extrapolation_length(eta);
    const auto radiance = [&](double c) { return z + refracted_cosine(c, eta); };
    lobe.diffuse = fit_lobe(eta, [&](double c) { return c * radiance(c); }).mean /
                   fit_lobe(eta, radiance).mean;
    lobe.eta = eta;
    return lobe;
}

glm::vec4 ExitLobe::eval(glm::vec3 normal, glm::vec3 exit) const {
    const float cosine = glm::dot(normal, exit);
    if (!(cosine > 0)) {
        return {1, 0, 0, 0};  // of another facet
    }
    const auto along = static_cast<float>((static_cast<double>(cosine) - mean) / variance);
    const auto sideways = static_cast<float>(1 / across);
    const glm::vec3 a = along * normal + sideways * (exit - cosine * normal);
    return {1 - static_cast<float>(mean) * along, a};
}

glm::vec4 ExitLobe::eval_diffuse(glm::vec3 normal, glm::vec3 drift) const {
    const auto along = static_cast<float>((diffuse - mean) / variance);
    // Light inside that drifts has a radiance of 1 + 3 drift . w in proportion; at the boundary it
    // drifts less than on average over the walk (README.md, "The light at an exit").
    constexpr double kAtBoundary = 0.65;
    const auto sideways = static_cast<float>(3 * kAtBoundary / eta);
    const glm::vec3 a = along * normal + sideways * (drift - glm::dot(normal, drift) * normal);
    return {1 - static_cast<float>(mean) * along, a};
}

ExitLight::ExitLight(std::span<const SurfaceSample> samples, const SparseVectors& light,
                     const std::array<SparseVectors, 3>* moments, double eta, double escape,
                     const SparseVectors* other)
    : samples_(samples),
      light_(light),
      moments_(moments),
      other_(other),
      lobe_(make_exit_lobe(eta)),
      scale_(static_cast<float>(1 / (std::numbers::pi * escape))),
      grid_(sample_points(samples), cell_size(samples)) {}

std::uint32_t ExitLight::nearest(const WalkExit& exit, std::vector<std::uint32_t>& around) const {
    constexpr float kFacing = 0.3f;
    const auto search = [&](auto&& candidates) {
        std::uint32_t best = formats::kNone, any = formats::kNone;
        float best_distance = std::numeric_limits<float>::max(), any_distance = best_distance;
        for (const std::uint32_t j : candidates) {
            const glm::vec3 d = samples_[j].position - exit.position;
            const float distance = glm::dot(d, d);
            if (distance < any_distance) {
                any = j, any_distance = distance;
            }
            if (distance < best_distance && glm::dot(samples_[j].normal, exit.normal) > kFacing) {
                best = j, best_distance = distance;
            }
        }
        return best != formats::kNone ? best : any;
    };
    grid_.collect_around(grid_.cell_of(exit.position), around);
    const std::uint32_t near = search(around);
    if (near != formats::kNone) {
        return near;
    }
    around.resize(samples_.size());
    for (std::uint32_t j = 0; j < samples_.size(); ++j) {
        around[j] = j;
    }
    return search(around);
}

glm::vec4 ExitLight::factors(std::uint32_t sample, const WalkExit& exit) const {
    const SurfaceSample& s = samples_[sample];
    const float scale = s.area > 0 ? scale_ / s.area : 0;
    if (moments_ == nullptr) {
        return {scale, 0, 0, 0};
    }
    return scale * (exit.is_diffuse ? lobe_.eval_diffuse(s.normal, exit.drift)
                                    : lobe_.eval(s.normal, exit.direction));
}

void ExitLight::add(std::uint32_t sample, const std::array<glm::vec4, 3>& factors,
                    std::span<float> rgbx) const {
    for (int vector = 0; vector < (moments_ == nullptr ? 1 : 4); ++vector) {
        const SparseVector entries =
            vector == 0 ? light_[sample]
                        : (*moments_)[static_cast<std::size_t>(vector - 1)][sample];
        const Float4 factor{factors[0][vector], factors[1][vector], factors[2][vector], 0};
        for (std::size_t i = 0; i < entries.index.size(); ++i) {
            add_to(&rgbx[4 * std::size_t{entries.index[i]}], factor * entries.value[i]);
        }
    }
    if (other_ != nullptr) {
        // The mean of a_0 + a . w over diffuse light that enters: w is lobe_.mean along n.
        std::array<float, 3> weight{};
        for (std::size_t b = 0; b < weight.size(); ++b) {
            const glm::vec3 a{factors[b].y, factors[b].z, factors[b].w};
            weight[b] = factors[b].x +
                        static_cast<float>(lobe_.mean) * glm::dot(a, samples_[sample].normal);
        }
        add_other(sample, weight, rgbx);
    }
}

void ExitLight::add_other(std::uint32_t sample, const std::array<float, 3>& weight,
                          std::span<float> rgbx) const {
    const SparseVector entries = (*other_)[sample];
    for (std::size_t i = 0; i < entries.index.size(); ++i) {
        float* const to = &rgbx[4 * std::size_t{entries.index[i]}];
        for (std::size_t b = 0; b < weight.size(); ++b) {
            to[b] += weight[b] * entries.value[other_->bands == 1 ? i : 3 * i + b];
        }
    }
}

void ExitLight::add_views(std::uint32_t sample, std::span<const std::array<float, 3>> weight,
                          std::span<float> rows) const {
    const SurfaceSample& s = samples_[sample];
    const float scale = s.area > 0 ? scale_ / s.area : 0;
    const SparseVector entries = light_[sample];
    const std::size_t size = rows.size() / weight.size();
    for (std::size_t row = 0; row < weight.size(); ++row) {
        const Float4 factor{scale * weight[row][0], scale * weight[row][1], scale * weight[row][2],
                            0};
        float* const to = &rows[row * size];
        for (std::size_t i = 0; i < entries.index.size(); ++i) {
            add_to(&to[4 * std::size_t{entries.index[i]}], factor * entries.value[i]);
        }
        if (other_ != nullptr) {
            add_other(sample, {factor[0], factor[1], factor[2]}, rows.subspan(row * size, size));
        }
    }
}

}  // namespace opaline::bake
