#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <random>

#include "bake/base/largest.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/parallel_indices.h"

namespace opaline::bake {
namespace {

// A sum of floats whose rounding depends on its order, over blocks that take unequal time.
float sum_in_order(std::size_t count, std::size_t block, unsigned threads) {
    Context context;
    context.threads = threads;
    float sum = 0;
    for_each_block_in_order(
        count, block, context,
        [](Range range) {
            std::vector<float> terms;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                float value = 1 / (1 + static_cast<float>(i));
                for (std::size_t k = 0; k < 50 * (i % 17); ++k) {
                    value = std::sin(value);
                }
                terms.push_back(value);
            }
            return terms;
        },
        [&](Range range, std::vector<float>&& terms) {
            EXPECT_EQ(terms.size(), range.end - range.begin);
            sum = std::accumulate(terms.begin(), terms.end(), sum);
        });
    return sum;
}

TEST(Loops, BlocksAreConsumedInOrderForAnyNumberOfThreads) {
    for (const std::size_t count : {0u, 1u, 7u, 1000u}) {
        for (const std::size_t block : {1u, 8u, 2000u}) {
            const float one = sum_in_order(count, block, 1);
            for (const unsigned threads : {2u, 3u, 8u}) {
                EXPECT_EQ(sum_in_order(count, block, threads), one) << count << " by " << block;
            }
        }
    }
}

TEST(Loops, CancelledOnesStopAndConsumeAPrefix) {
    std::atomic<bool> cancel = false;
    Context context;
    context.threads = 3;
    context.cancel = &cancel;
    std::size_t consumed = 0;
    for_each_block_in_order(
        100000, 1, context, [](Range range) { return range.begin; },
        [&](Range range, std::size_t&& begin) {
            EXPECT_EQ(range.begin, consumed);
            EXPECT_EQ(begin, consumed++);
            if (consumed == 5) cancel = true;
        });
    EXPECT_GE(consumed, 5u);
    EXPECT_LT(consumed, 100u);
}

TEST(Loops, EachIndexIsVisitedOnce) {
    std::vector<std::atomic<int>> visits(10000);
    for_each_index(visits.size(), [&](std::size_t i) { ++visits[i]; });
    for (const std::atomic<int>& n : visits) {
        ASSERT_EQ(n, 1);
    }
}

std::vector<std::uint32_t> by_sorting(const std::vector<float>& score, std::size_t count) {
    std::vector<std::uint32_t> all(score.size());
    std::iota(all.begin(), all.end(), 0u);
    std::stable_sort(all.begin(), all.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return score[a] > score[b]; });
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < std::min(count, all.size()) && score[all[i]] > 0; ++i) {
        chosen.push_back(all[i]);
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

TEST(Largest, AreThoseThatSortingFinds) {
    std::mt19937 generator(1);
    for (const float spread : {0.0f, 0.01f, 3.0f, 40.0f}) {
        std::normal_distribution<float> exponent(0, spread);
        std::vector<float> score(3000);
        for (float& s : score) {
            s = std::exp(std::min(exponent(generator), 88.0f));
        }
        for (const std::size_t count : {0u, 1u, 7u, 128u, 2999u, 3000u, 9999u}) {
            EXPECT_EQ(find_largest(score, count), by_sorting(score, count)) << spread;
        }
    }
}

TEST(Largest, OnlyPositiveOnesCount) {
    EXPECT_EQ(find_largest(std::vector<float>{0, -5, 1e-45f, 3e38f, -0.0f}, 4),
              (std::vector<std::uint32_t>{2, 3}));
    EXPECT_TRUE(find_largest({}, 4).empty());
}

}  // namespace

}  // namespace opaline::bake
