#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bake/effects/multiple/walks/walk.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSpread = 7;

std::array<float, 2 * kSpread> numbers(std::uint32_t start, std::uint32_t walk, bool spread) {
    WalkRandom random({0, RandomStage::body_walk, start, walk}, spread);
    std::array<float, 2 * kSpread> drawn{};
    for (float& number : drawn) {
        number = random.next();
    }
    return drawn;
}

// Counts of 64 walks in 16 bins of one number vary far less than random ones, whose variance is
// their mean; those in 8 x 8 cells of the first two, which make the direction, somewhat less.
TEST(WalkRandom, FirstNumbersOfWalksFromOnePlaceAreSpreadEvenly) {
    constexpr std::uint32_t kWalks = 64, kStarts = 20;
    double two = 0;
    std::array<double, kSpread> one{};
    for (std::uint32_t start = 0; start < kStarts; ++start) {
        std::array<std::array<double, 16>, kSpread> bins{};
        std::array<double, 64> cells{};
        for (std::uint32_t walk = 0; walk < kWalks; ++walk) {
            const auto u = numbers(start, walk, true);
            for (std::size_t d = 0; d < kSpread; ++d) {
                ASSERT_TRUE(u[d] >= 0 && u[d] < 1);
                ++bins[d][static_cast<std::size_t>(16 * u[d])];
            }
            ++cells[static_cast<std::size_t>(8 * u[0]) + 8 * static_cast<std::size_t>(8 * u[1])];
        }
        for (std::size_t d = 0; d < kSpread; ++d) {
            for (const double n : bins[d]) {
                one[d] += (n - 4) * (n - 4) / (4 * 16 * kStarts);
            }
        }
        for (const double n : cells) {
            two += (n - 1) * (n - 1) / (64 * kStarts);
        }
    }
    for (std::size_t d = 0; d < kSpread; ++d) {
        EXPECT_LT(one[d], 0.35) << d;
    }
    EXPECT_LT(two, 0.9);
}

// Over places each number is uniform and independent of the others.
TEST(WalkRandom, SpreadNumbersAreUniformOverPlaces) {
    constexpr std::uint32_t kStarts = 4000;
    std::array<double, 2 * kSpread> mean{}, square{}, with_next{};
    for (std::uint32_t start = 0; start < kStarts; ++start) {
        const auto u = numbers(start, 11, true);
        for (std::size_t d = 0; d < u.size(); ++d) {
            const double own = static_cast<double>(u[d]) - 0.5;
            mean[d] += own / kStarts;
            square[d] += own * own / kStarts;
            with_next[d] += own * (static_cast<double>(u[(d + 1) % u.size()]) - 0.5) / kStarts;
        }
    }
    const double allowed = 4 / std::sqrt(12.0 * kStarts);  // four standard errors of the mean
    for (std::size_t d = 0; d < mean.size(); ++d) {
        EXPECT_NEAR(mean[d], 0, allowed) << d;
        EXPECT_NEAR(square[d], 1.0 / 12, 0.3 * allowed) << d;
        EXPECT_NEAR(with_next[d], 0, 0.3 * allowed) << d;
    }
}

}  // namespace
}  // namespace opaline::bake
