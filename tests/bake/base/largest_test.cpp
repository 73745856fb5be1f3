#include "bake/base/largest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace opaline::bake {
namespace {

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
