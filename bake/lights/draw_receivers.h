#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/base/rng.h"

namespace opaline::bake {

/// `wanted` of `count` distinct indices, ascending, one from each of `wanted` equal runs, so that
/// they cover all primitives. Drawn by (seed, stage).
std::vector<std::uint32_t> draw_evenly(std::size_t count, std::size_t wanted, RandomStage stage,
                                       std::uint64_t seed);

/// How many receivers the self-check compares with the truth out of `receivers`; as many points
/// between them are compared as well. With these numbers the check costs at most a tenth of the
/// bake, except in small scenes: the truth of a point costs as much as the rows of some ten
/// receivers at N = 16 and of two or three at N = 32, whatever the scene.
inline std::size_t count_checked(std::size_t receivers, std::uint32_t cubemap_size) {
    constexpr std::size_t kLeast = 32, kMost = 1024;
    // 1 in 96 at N = 32, in proportion to N, but not more often.
    constexpr std::size_t kReceiversPerCheck = 96, kFullSize = 32;
    const std::size_t share = std::min<std::size_t>(cubemap_size, kFullSize);
    const std::size_t wanted = receivers * share / (kReceiversPerCheck * kFullSize);
    return std::min(receivers, std::clamp(wanted, kLeast, kMost));
}

/// The most of these where the truth of each costs as much as the rows of dozens.
inline constexpr std::size_t kMostExpensiveChecks = 128;

}  // namespace opaline::bake
