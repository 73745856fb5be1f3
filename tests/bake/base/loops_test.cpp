#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>

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

}  // namespace
}  // namespace opaline::bake
