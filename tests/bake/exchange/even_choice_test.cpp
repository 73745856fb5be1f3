#include "bake/exchange/even_choice.h"

#include <gtest/gtest.h>

#include <set>

#include "bake/base/rng.h"

namespace opaline::bake {
namespace {

std::vector<SidePoint> scattered(std::uint32_t count) {
    std::vector<SidePoint> points;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto u = random_uniform(1, RandomStage::bounce_rays, i);
        const bool behind = i % 4 == 0;
        points.push_back({{u[0], 0, u[1]}, {0, behind, {0, behind ? -1.0f : 1.0f, 0}}});
    }
    return points;
}

TEST(EvenChoice, EachSideHasItsShareAndNoPointComesTwice) {
    const auto points = scattered(4000);
    const auto chosen = choose_evenly(points, 400);
    EXPECT_EQ(chosen.size(), 400u);
    EXPECT_EQ(std::set<std::uint32_t>(chosen.begin(), chosen.end()).size(), 400u);
    std::size_t behind = 0;
    for (const std::uint32_t i : chosen) {
        behind += points[i].side.behind ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(behind), 100, 1);
    EXPECT_EQ(choose_evenly(points, 9000).size(), 4000u) << "all there are";
    EXPECT_TRUE(choose_evenly({}, 10).empty());
}

// 300 of one side over the unit square: cells of 1 / 300. Random choice leaves pairs closer than a
// tenth of the width of a cell; cells of as many neighbours each do not.
TEST(EvenChoice, ChosenPointsKeepTheirDistance) {
    const auto points = scattered(16000);
    const auto chosen = choose_evenly(points, 400);
    std::size_t close = 0;
    for (const std::uint32_t a : chosen) {
        for (const std::uint32_t b : chosen) {
            close += a != b && !points[a].side.behind && !points[b].side.behind &&
                             glm::distance(points[a].position, points[b].position) < 0.02f
                         ? 1
                         : 0;
        }
    }
    // At random: 300 of them with pi 0.02^2 300 = 0.38 others.
    EXPECT_LT(close, 20u);
}

TEST(EvenChoice, OfPointsAtOnePlaceEachComesOnce) {
    const std::vector<SidePoint> points(1000, {{1, 1, 1}, {0, false, {0, 1, 0}}});
    for (const std::size_t count : {1u, 7u, 999u, 1000u}) {
        const auto chosen = choose_evenly(points, count);
        EXPECT_EQ(chosen.size(), count);
        EXPECT_EQ(std::set<std::uint32_t>(chosen.begin(), chosen.end()).size(), count);
    }
}

}  // namespace
}  // namespace opaline::bake
