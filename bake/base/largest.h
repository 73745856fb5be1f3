#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// Indices of the `count` largest positive entries of `score`, ascending; of equal ones the first.
/// Fewer where fewer are positive. Finite values only. Linear time: a histogram over the leading
/// bits of the scores leaves few to be ordered.
inline std::vector<std::uint32_t> find_largest(std::span<const float> score, std::size_t count) {
    // Positive floats order as their bits do: exponent and the first three bits of the mantissa.
    constexpr std::uint32_t kShift = 20;
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    std::array<std::uint32_t, std::size_t{1} << (31 - kShift)> histogram{};
    for (const float value : score) {
        histogram[value > 0 ? bits(value) >> kShift : 0] += value > 0 ? 1 : 0;
    }
    std::size_t above = 0;  // entries in higher buckets than `last`
    std::size_t last = histogram.size() - 1;
    while (last > 0 && above + histogram[last] <= count) {
        above += histogram[last--];
    }
    std::vector<std::uint32_t> chosen, candidates;
    chosen.reserve(count);
    for (std::uint32_t k = 0; k < score.size(); ++k) {
        if (score[k] > 0 && bits(score[k]) >> kShift >= last) {
            (bits(score[k]) >> kShift > last ? chosen : candidates).push_back(k);
        }
    }
    const std::size_t rest = std::min(count - above, candidates.size());
    const auto middle = candidates.begin() + static_cast<std::ptrdiff_t>(rest);
    if (middle != candidates.end()) {
        std::nth_element(candidates.begin(), middle, candidates.end(),
                         [score](std::uint32_t a, std::uint32_t b) {
                             return score[a] != score[b] ? score[a] > score[b] : a < b;
                         });
    }
    chosen.insert(chosen.end(), candidates.begin(), middle);
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

}  // namespace opaline::bake
