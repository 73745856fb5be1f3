#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/base/rng.h"

namespace opaline::bake {

/// `wanted` of `count` indices, ascending, one from each of as many equal runs: spread over all
/// primitives, never twice the same. Drawn by (seed, stage).
std::vector<std::uint32_t> draw_evenly(std::size_t count, std::size_t wanted, RandomStage stage,
                                       std::uint64_t seed);

inline constexpr std::size_t kLeastChecked = 16, kMostChecked = 1024, kReceiversPerCheck = 40;
/// Of those, where the truth of each costs as much as the rows of dozens: enough to tell a tenth.
inline constexpr std::size_t kMostExpensiveChecks = 256;

/// Receivers to check out of `count`, ascending: about one in forty, 16 to 1024, drawn by
/// (seed, draw) so that the check costs at most a tenth of the bake.
std::vector<std::uint32_t> draw_receivers(std::size_t count, std::uint64_t seed);

}  // namespace opaline::bake
