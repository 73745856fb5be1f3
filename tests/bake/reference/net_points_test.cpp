
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bake/reference/random_stream.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

TEST(NetPoints, OfTheFirst2PowKOneLiesInEveryElementaryInterval) {
    for (std::uint64_t key = 0; key < 50; ++key) {
        for (std::uint32_t count = 1; count <= 16; count *= 2) {
            for (std::uint32_t columns = 1; columns <= count; columns *= 2) {
                const std::uint32_t rows = count / columns;
                std::array<int, 16> found{};
                for (std::uint32_t i = 0; i < count; ++i) {
                    const glm::vec2 p = bake::net_point(bake::mix_bits(key), 3, i);
                    ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
                    const auto x = static_cast<std::uint32_t>(p.x * static_cast<float>(columns));
                    const auto y = static_cast<std::uint32_t>(p.y * static_cast<float>(rows));
                    ++found[y * columns + x];
                }
                for (std::uint32_t cell = 0; cell < count; ++cell) {
                    ASSERT_EQ(found[cell], 1) << columns << " x " << rows;
                }
            }
        }
    }
}

// Over keys, every point by itself is uniform, and so are two numbers of unlike pairs or two points
// of one pair where no net ties them.
TEST(NetPoints, APointIsUniformAndIndependentOfOtherPairs) {
    constexpr std::uint64_t kKeys = 20000;
    constexpr int kCells = 8;
    for (const std::uint32_t i : {0u, 5u, 15u}) {
        std::array<double, kCells * kCells> within{}, across{};
        for (std::uint64_t key = 0; key < kKeys; ++key) {
            const glm::vec2 p = bake::net_point(bake::mix_bits(key), 0, i);
            const glm::vec2 q = bake::net_point(bake::mix_bits(key), 1, i);
            const auto cell = [](float a, float b) {
                return static_cast<std::size_t>(a * kCells) * kCells +
                       static_cast<std::size_t>(b * kCells);
            };
            within[cell(p.x, p.y)] += 1;
            across[cell(p.x, q.x)] += 1;
        }
        double chi[2] = {};
        const double expected = static_cast<double>(kKeys) / (kCells * kCells);
        for (std::size_t c = 0; c < within.size(); ++c) {
            chi[0] += std::pow(within[c] - expected, 2) / expected;
            chi[1] += std::pow(across[c] - expected, 2) / expected;
        }
        const double freedom = kCells * kCells - 1;
        EXPECT_LT(chi[0], freedom + 4 * std::sqrt(2 * freedom)) << i;
        EXPECT_LT(chi[1], freedom + 4 * std::sqrt(2 * freedom)) << i;
    }
}

TEST(RandomStream, NumbersOfAnEventDoNotDependOnWhatWasDrawnBefore) {
    bake::RandomStream one(1, 2, 3), two(1, 2, 3);
    one.start_event();
    two.start_event();
    one.next();
    one.next_pair();
    one.start_event();
    two.start_event();
    EXPECT_EQ(one.next(), two.next());
    EXPECT_EQ(one.next_pair(), two.next_pair());
}

TEST(RandomStream, NoNumberComesTwice) {
    bake::RandomStream random(1, 2, 3);
    std::vector<float> seen;
    for (int event = 0; event < 12; ++event) {
        random.start_event();
        for (int i = 0; i < 25; ++i) {
            seen.push_back(random.next());
        }
    }
    std::sort(seen.begin(), seen.end());
    // By chance 300 numbers of 24 bits hold an equal pair once in 400 streams; this one has none.
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

// Means of x y over the square, of as many samples as are asked for: unbiased for any number, and
// the stated errors are those that are found, or larger where there are few groups.
TEST(Estimate, StatedErrorsOfStratifiedSamplesAreHonest) {
    for (const std::uint32_t samples : {5u, 16u, 40u, 160u}) {
        bake::EstimateOptions options;
        options.samples = samples;
        const auto estimate =
            bake::estimate_pixels(2000, options, {}, [](std::uint32_t, bake::RandomStream& random) {
                random.start_event();
                const glm::vec2 p = random.next_pair();
                return bake::PathSample{glm::vec3(p.x * p.y), false, 0};
            });
        ASSERT_TRUE(estimate);
        double sum = 0, squares = 0, stated = 0;
        for (const bake::Moments& m : estimate->pixel) {
            sum += m.mean.x - 0.25;
            squares += std::pow(m.mean.x - 0.25, 2);
            stated += m.variance_of_mean().x;
        }
        EXPECT_LT(std::abs(sum), 4 * std::sqrt(squares)) << samples;
        const double independent = (1.0 / 9 - 1.0 / 16) * 2000 / samples;
        if (samples >= 64) {
            EXPECT_NEAR(squares / stated, 1, 0.15) << samples;
        } else {
            EXPECT_LT(squares, 1.1 * stated) << samples;
            EXPECT_NEAR(stated / independent, 1, 0.3) << samples;
        }
        EXPECT_LT(squares, 0.5 * independent) << samples;
    }
}

}  // namespace
}  // namespace opaline::tests
