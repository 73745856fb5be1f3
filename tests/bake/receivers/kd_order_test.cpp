#include "bake/receivers/kd_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace opaline::bake {
namespace {

std::vector<SurfaceSample> scattered(std::size_t count) {
    std::vector<SurfaceSample> samples(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto t = static_cast<float>(i);
        samples[i].position = {3 * std::sin(12.9898f * t), std::sin(78.233f * t),
                               2 * std::cos(37.719f * t)};
    }
    return samples;
}

// In every node, no sample of the second child lies before one of the first along the longest side.
void expect_split(std::span<const SurfaceSample> samples, std::span<const std::uint32_t> order) {
    const auto count = static_cast<std::uint32_t>(order.size());
    if (count <= kSamplesPerLeaf) return;
    const std::uint32_t half = first_child_count(count);
    ASSERT_GT(half, 0u);
    ASSERT_LT(half, count);
    EXPECT_EQ(half % (count > kSamplesPerGroup ? kSamplesPerGroup : kSamplesPerLeaf), 0u);
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const std::uint32_t i : order) {
        low = glm::min(low, samples[i].position);
        high = glm::max(high, samples[i].position);
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        axis = high[k] - low[k] > high[axis] - low[axis] ? k : axis;
    }
    float first = -INFINITY, second = INFINITY;
    for (std::uint32_t k = 0; k < count; ++k) {
        const float x = samples[order[k]].position[axis];
        k < half ? first = std::max(first, x) : second = std::min(second, x);
    }
    EXPECT_LE(first, second) << count;
    expect_split(samples, order.first(half));
    expect_split(samples, order.subspan(half));
}

TEST(KdOrder, EveryNodeIsARunSplitWhereItIsLongest) {
    for (const std::size_t count : {0, 1, 8, 9, 15, 16, 17, 31, 33, 200, 1000}) {
        const std::vector<SurfaceSample> samples = scattered(count);
        const std::vector<std::uint32_t> order = kd_order(samples);
        std::vector<std::uint32_t> sorted = order, all(count);
        std::ranges::sort(sorted);
        std::iota(all.begin(), all.end(), 0u);
        EXPECT_EQ(sorted, all) << count;
        expect_split(samples, order);
    }
}

TEST(KdOrder, OfSamplesAtOnePlaceHasThemAll) {
    const std::vector<SurfaceSample> samples(1000);
    std::vector<std::uint32_t> order = kd_order(samples), all(samples.size());
    expect_split(samples, order);
    std::ranges::sort(order);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(order, all);
}

}  // namespace
}  // namespace opaline::bake
