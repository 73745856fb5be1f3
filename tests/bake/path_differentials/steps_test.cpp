#include "bake/path_differentials/steps.h"

#include <gtest/gtest.h>

#include <limits>

namespace opaline::bake {
namespace {

TEST(Steps, GlobalOnesAreThoseOfTheLiterature) {
    EXPECT_NEAR(global_step(400000, 4, 1), 0.0398, 5e-5);
    EXPECT_NEAR(global_step(400000, 6, 1), 0.1165, 5e-5);
    EXPECT_NEAR(global_step(400000, 8, 1), 0.1994, 5e-5);
    EXPECT_NEAR(global_step(400000, 6, 0.25), 0.1468, 5e-5);
}

TEST(Steps, NeverExceedTheDomain) {
    EXPECT_EQ(global_step(10, 4, 0.01), 1);
    EXPECT_EQ(global_step(10, 0, 1), 1);
    EXPECT_EQ(event_step(1), 1);
    EXPECT_EQ(event_step(0.1), 1);
    EXPECT_EQ(event_step(16), 0.25);
}

TEST(Steps, LimitHoldsForBothSignsAndLeavesEvenContributionsAlone) {
    EXPECT_EQ(limited_step(0.5, 0, 0.7), 0.5);
    EXPECT_EQ(limited_step(0.5, 1, 0.7), 0.5);
    EXPECT_DOUBLE_EQ(limited_step(0.5, -14, 0.7), 0.05);
    EXPECT_DOUBLE_EQ(limited_step(0.5, 14, 0.7), 0.05);
    EXPECT_EQ(limited_step(0.5, 1e9, std::numeric_limits<double>::infinity()), 0.5);
}

}  // namespace
}  // namespace opaline::bake
