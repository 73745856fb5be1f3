// How many sites stand how far apart, and how many walks start from them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/effects/multiple/walks/walk_stage.h"

namespace opaline::tests {
namespace {

TEST(SitePlan, SitesStandAsTheMeanFreePathAsksUpToTheirNumber) {
    const bake::SitePlan wide = bake::plan_sites(4, 2, 0.05, {1000, 1e9, 100000});
    EXPECT_FALSE(wide.is_residual);
    EXPECT_GT(wide.radius, 0.05);
    const bake::SitePlan dense = bake::plan_sites(4, 2, 0.001, {1000, 1e9, 20000});
    EXPECT_TRUE(dense.is_residual);
    EXPECT_EQ(dense.sites, 20000u);
    EXPECT_NEAR(dense.radius, 1.8 * std::sqrt(4.0 / 20000), 1e-6);
    // As many around each receiver, whatever the radius.
    EXPECT_NEAR(bake::count_walks(wide, 4, {1000, 1e9, 100000}),
                1000 * 4 / (std::numbers::pi * wide.radius * wide.radius), 1);
    EXPECT_EQ(bake::count_walks(wide, 4, {1000, 5000, 100000}), 5000);
    EXPECT_NEAR(bake::plan_sites(4, 2, 100, {1000, 1e9, 20000}).radius, 0.06, 1e-9)
        << "no wider than features";
    const bake::SitePlan few = bake::plan_sites(4, 2, 100, {1000, 1e4, 20000});
    EXPECT_NEAR(few.radius, 0.1, 1e-9) << "unless walks are few";
    EXPECT_FALSE(few.is_residual) << "transport itself is wider";
}

TEST(SitePlan, FewWalksAreCountedFartherAroundSoThatNoiseStaysTheSame) {
    constexpr double kArea = 4, kDiagonal = 2, kAround = 10000, kMost = 4e6;
    const bake::WalkBudget budget{kAround, kMost, 40000};
    const bake::SitePlan plan = bake::plan_sites(kArea, kDiagonal, 0.01, budget);
    EXPECT_TRUE(plan.is_residual) << "too wide for the transport itself";
    EXPECT_NEAR(bake::count_walks(plan, kArea, budget) * std::numbers::pi * plan.radius *
                    plan.radius / kArea,
                kAround, 0.01 * kAround);
}

// 100 receivers on 4 m^2 are 0.2 m apart, a tenth of a diagonal of 2 m.
TEST(SitePlan, WalksAreInProportionToFewReceivers) {
    constexpr double kArea = 4, kDiagonal = 2, kAround = 1000;
    const bake::WalkBudget budget{kAround, 1e9, 20000};
    const bake::SitePlan dense = bake::plan_sites(kArea, kDiagonal, 0.001, budget);
    ASSERT_TRUE(dense.is_residual);
    bake::SitePlan plan = dense;
    bake::widen_for_receivers(plan, kArea, kDiagonal, 1e6);
    EXPECT_EQ(plan.radius, dense.radius) << "receivers are closer than sites reach";
    EXPECT_EQ(plan.sites, dense.sites);
    bake::widen_for_receivers(plan, kArea, kDiagonal, 100);
    EXPECT_NEAR(plan.radius, 0.2, 1e-9);
    EXPECT_GT(plan.sites, 100u);
    EXPECT_LT(plan.sites, 1000u);
    EXPECT_NEAR(bake::count_walks(plan, kArea, budget), kAround * 100 / std::numbers::pi, 1);
    bake::widen_for_receivers(plan, kArea, kDiagonal, 1);
    EXPECT_NEAR(plan.radius, 0.2, 1e-9) << "no wider than a tenth of the body";
    bake::SitePlan alone = bake::plan_sites(kArea, kDiagonal, 0.05, budget);
    const double radius = alone.radius;
    bake::widen_for_receivers(alone, kArea, kDiagonal, 100);
    EXPECT_EQ(alone.radius, radius) << "what is no residual is not as smooth";
}

}  // namespace
}  // namespace opaline::tests
