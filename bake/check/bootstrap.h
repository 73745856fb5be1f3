#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/rng.h"

namespace opaline::bake {

/// 95 % percentile bootstrap interval of `statistic`, a function of which of `count` items (> 0)
/// were drawn, with repetition, as many as there are. Pure function of its arguments.
template <class Statistic>
std::array<double, 2> bootstrap_interval(std::size_t count, std::uint64_t seed,
                                         Statistic&& statistic) {
    constexpr std::uint32_t kResamples = 1000;
    std::vector<double> estimate(kResamples);
    std::vector<std::size_t> drawn(count);
    for (std::uint32_t r = 0; r < kResamples; ++r) {
        for (std::size_t i = 0; i < count; ++i) {
            const double u =
                static_cast<double>(random_uniform(seed, RandomStage::bootstrap, i, r)[0]);
            drawn[i] = static_cast<std::size_t>(u * static_cast<double>(count));
        }
        estimate[r] = statistic(std::span<const std::size_t>(drawn));
    }
    std::sort(estimate.begin(), estimate.end());
    return {estimate[static_cast<std::size_t>(0.025 * kResamples)],
            estimate[static_cast<std::size_t>(0.975 * kResamples)]};
}

}  // namespace opaline::bake
