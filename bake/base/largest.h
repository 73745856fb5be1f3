#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// Indices of the `count` largest positive entries of `score`, ascending; ties go to the smaller
/// index. Fewer if fewer are positive. Finite values only. Linear time: a histogram over the
/// leading bits leaves few entries to sort.
inline std::vector<std::uint32_t> find_largest(std::span<const float> score, std::size_t count) {
    // Positive floats order as their bits do: exponent and the first two bits of the mantissa.
    constexpr std::uint32_t kShift = 21;
    constexpr std::size_t kBuckets = std::size_t{1} << (31 - kShift);
    const auto bucket_of = [](float value) {
        return value > 0 ? std::bit_cast<std::uint32_t>(value) >> kShift : 0u;
    };
    // Neighbouring entries often share a bucket. Four histograms keep them independent.
    std::array<std::array<std::uint32_t, kBuckets>, 4> histogram{};
    std::size_t k = 0;
    for (; k + 4 <= score.size(); k += 4) {
        ++histogram[0][bucket_of(score[k])];
        ++histogram[1][bucket_of(score[k + 1])];
        ++histogram[2][bucket_of(score[k + 2])];
        ++histogram[3][bucket_of(score[k + 3])];
    }
    for (; k < score.size(); ++k) {
        ++histogram[0][bucket_of(score[k])];
    }
    std::size_t above = 0;  // entries in higher buckets than `last`
    std::size_t last = kBuckets - 1;
    for (; last > 0; --last) {
        const std::size_t here = std::size_t{histogram[0][last]} + histogram[1][last] +
                                 histogram[2][last] + histogram[3][last];
        if (above + here > count) break;
        above += here;
    }
    // Each is written and stays where it is one: no branch to mispredict.
    const std::size_t in_last = std::size_t{histogram[0][last]} + histogram[1][last] +
                                histogram[2][last] + histogram[3][last];
    std::vector<std::uint32_t> chosen(above + 1), candidates(in_last + 1);
    std::size_t higher = 0, same = 0;
    const float least = std::bit_cast<float>(static_cast<std::uint32_t>(last << kShift));
    const float beyond = std::bit_cast<float>(static_cast<std::uint32_t>((last + 1) << kShift));
    for (std::uint32_t i = 0; i < score.size(); ++i) {
        const float s = score[i];
        chosen[higher] = i;
        candidates[same] = i;
        const bool is_higher = s >= beyond;
        higher += is_higher ? 1 : 0;
        same += static_cast<std::size_t>(s >= least) & static_cast<std::size_t>(s > 0) &
                static_cast<std::size_t>(!is_higher);
    }
    chosen.resize(higher);
    candidates.resize(same);
    const std::size_t rest = std::min(count - above, candidates.size());
    const auto middle = candidates.begin() + static_cast<std::ptrdiff_t>(rest);
    if (middle != candidates.end()) {
        std::nth_element(candidates.begin(), middle, candidates.end(),
                         [score](std::uint32_t a, std::uint32_t b) {
                             return score[a] != score[b] ? score[a] > score[b] : a < b;
                         });
    }
    // Both parts ascend: entries of higher buckets were found in index order.
    std::sort(candidates.begin(), middle);
    const auto found = static_cast<std::ptrdiff_t>(chosen.size());
    chosen.insert(chosen.end(), candidates.begin(), middle);
    std::inplace_merge(chosen.begin(), chosen.begin() + found, chosen.end());
    return chosen;
}

}  // namespace opaline::bake
