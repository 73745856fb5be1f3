#include "bake/exchange/bounce_ends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/bake/exchange/bounce_support.h"

namespace opaline::bake {
namespace {

// Shares of a point's irradiance that surfaces cover, one for each of many seeds.
struct Shares {
    double mean = 0, deviation = 0, rays = 0;
};

Shares cover(const formats::Scene& scene, const Receiver& at, const BounceGrid& grid,
             std::uint64_t seeds) {
    const RayScene rays = RayScene::build(scene, 1).value();
    double sum = 0, squares = 0, traced = 0;
    std::vector<BounceEnd> ends;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        traced += static_cast<double>(find_bounce_ends(scene, rays, at, grid, seed, ends));
        double share = 0;
        for (const BounceEnd& end : ends) {
            share += end.is_met ? (end.is_quarter ? 0.25 : 1) / grid.count() : 0;
        }
        sum += share;
        squares += share * share;
    }
    const auto n = static_cast<double>(seeds);
    return {sum / n, std::sqrt(squares / n - sum * sum / (n * n)), traced / n};
}

const Receiver kMiddle{{0.5f, 1e-5f, 0.5f}, {0, 1, 0}};

// The unit square at distance 1 above its middle: 4 / (2 pi) 2 X / sqrt(1 + X^2)
// atan(X / sqrt(1 + X^2)), X = 1/2.
TEST(BounceEnds, CellsCutAtEdgesKnowShapesBetterThanAsManyRaysInCellsOfOneSize) {
    const formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    const double root = std::sqrt(1.25);
    const double expected = 4 / std::numbers::pi * 0.5 / root * std::atan(0.5 / root);
    constexpr std::uint64_t kSeeds = 1024;
    const Shares cut = cover(scene, kMiddle, make_cut_grid(400), kSeeds);
    const Shares even = cover(scene, kMiddle, make_bounce_grid(400), kSeeds);
    EXPECT_LE(cut.rays, 400);
    EXPECT_LT(cut.deviation, 0.9 * even.deviation);
    EXPECT_NEAR(cut.mean, expected, 4 * cut.deviation / 32);
}

// A strip that is thinner than a cell by far: rays that meet it are few, and cells of these are not
// cut for it.
TEST(BounceEnds, ThinThingsCoverWhatTheyCover) {
    const formats::Scene scene =
        tests::make_scene({tests::make_quad({0.6f, 1, 0}, {0.02f, 0, 0}, {0, 0, 1}, 1)});
    constexpr std::uint64_t kSeeds = 4096;
    const Shares truth = cover(scene, kMiddle, make_bounce_grid(65536), 4);
    const Shares cut = cover(scene, kMiddle, make_cut_grid(400), kSeeds);
    EXPECT_NEAR(cut.mean, truth.mean, 4 * cut.deviation / 64);
    EXPECT_GT(truth.mean, 20 * cut.deviation / 64);
}

// A floor, seen from a wall: one edge, and most cells are left whole.
TEST(BounceEnds, WhereNeighboursSeeOnePlaneNothingIsCut) {
    const formats::Scene scene =
        tests::make_scene({tests::make_quad({-1e4f, 1, -1e4f}, {2e4f, 0, 0}, {0, 0, 2e4f}, 1)});
    const RayScene rays = RayScene::build(scene, 1).value();
    const BounceGrid grid = make_cut_grid(400);
    std::vector<BounceEnd> ends;
    EXPECT_EQ(find_bounce_ends(scene, rays, kMiddle, grid, 1, ends), 256u);
    EXPECT_TRUE(std::ranges::none_of(ends, &BounceEnd::is_quarter));
    EXPECT_TRUE(std::ranges::all_of(ends, &BounceEnd::sends));
    const std::uint64_t traced =
        find_bounce_ends(scene, rays, {{0, 0.5f, 0}, {1, 0, 0}}, grid, 1, ends);
    EXPECT_GT(traced, 256u);
    EXPECT_LE(traced, 400u);
    // Every quarter of a cell that was cut has one ray.
    std::vector<std::uint32_t> quarters;
    for (const BounceEnd& end : ends) {
        if (end.is_quarter) {
            quarters.push_back(end.cell);
        }
    }
    std::ranges::sort(quarters);
    EXPECT_TRUE(std::ranges::adjacent_find(quarters) == quarters.end());
}

}  // namespace
}  // namespace opaline::bake
