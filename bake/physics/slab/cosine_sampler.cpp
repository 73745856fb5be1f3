#include "bake/physics/slab/slab_walk.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace opaline::bake {

CosineSampler CosineSampler::henyey_greenstein(double g) {
    CosineSampler sampler;
    sampler.g_ = g;
    return sampler;
}

CosineSampler CosineSampler::tabulated(std::span<const double> cosine,
                                       std::span<const double> value) {
    assert(cosine.size() == value.size() && cosine.size() >= 2);
    CosineSampler sampler;
    sampler.cosine_.assign(cosine.begin(), cosine.end());
    sampler.value_.assign(value.begin(), value.end());
    double sum = 0;
    sampler.cumulative_.push_back(0);
    for (std::size_t i = 1; i < cosine.size(); ++i) {
        sum += (cosine[i] - cosine[i - 1]) * (value[i] + value[i - 1]) / 2;
        sampler.cumulative_.push_back(sum);
    }
    assert(sum > 0);
    for (double& x : sampler.value_) {
        x /= sum;
    }
    for (double& x : sampler.cumulative_) {
        x /= sum;
    }
    return sampler;
}

double CosineSampler::sample(double uniform) const {
    if (!cosine_.empty()) return sample_table(uniform);
    const double even = 2 * uniform - 1;
    constexpr double kNearlyIsotropic = 1e-4;  // the closed form cancels there
    if (std::abs(g_) < kNearlyIsotropic) {
        return std::clamp(even + 1.5 * g_ * (1 - even * even), -1.0, 1.0);
    }
    const double ratio = (1 - g_ * g_) / (1 + g_ * even);
    return std::clamp((1 + g_ * g_ - ratio * ratio) / (2 * g_), -1.0, 1.0);
}

double CosineSampler::sample_table(double uniform) const {
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, uniform);
    const auto i = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    // The root of a x + slope x^2 / 2 = rest, in the form that does not cancel.
    const double rest = std::max(0.0, uniform - cumulative_[i]);
    const double width = cosine_[i + 1] - cosine_[i], a = value_[i];
    const double slope = (value_[i + 1] - a) / width;
    const double denominator = a + std::sqrt(std::max(0.0, a * a + 2 * slope * rest));
    const double step = denominator > 0 ? 2 * rest / denominator : 0;
    return cosine_[i] + std::min(step, width);
}

}  // namespace opaline::bake
