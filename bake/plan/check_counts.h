#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace opaline::bake {

/// How many receivers the self-check compares with the truth out of `receivers`; as many points
/// between them are compared as well. With these numbers it costs a tenth of the bake at most, but
/// in small scenes: the truth of a point costs as much as the rows of some ten receivers at N = 16
/// and of two or three at N = 32, whatever the scene.
inline std::size_t count_checked(std::size_t receivers, std::uint32_t cubemap_size) {
    constexpr std::size_t kLeast = 32, kMost = 1024;
    // 1 in 96 at N = 32, in proportion to N, but not more often.
    constexpr std::size_t kReceiversPerCheck = 96, kFullSize = 32;
    const std::size_t share = std::min<std::size_t>(cubemap_size, kFullSize);
    const std::size_t wanted = receivers * share / (kReceiversPerCheck * kFullSize);
    return std::min(receivers, std::clamp(wanted, kLeast, kMost));
}

/// The most of these whose truth in a medium is found, which is some dozens of times dearer.
inline constexpr std::size_t kMostCheckedInMedia = 128;

}  // namespace opaline::bake
