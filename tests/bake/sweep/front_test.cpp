#include "bake/lab/sweep/analysis.h"

#include <gmock/gmock.h>

namespace opaline::bake {
namespace {

using ::testing::ElementsAre;

// cost, error: a and c are beaten by none, b costs as much as a and errs more, d costs more than c
// and errs as much.
const std::vector<CostPoint> kPoints{{1, 0.10}, {1, 0.20}, {4, 0.01}, {8, 0.01}, {2, 0.15}};

TEST(Front, HoldsWhatNoOtherBeatsInCostOrInError) {
    EXPECT_THAT(pareto_front(kPoints), ElementsAre(true, false, true, false, false));
}

TEST(Front, HoldsEqualPointsAndALonePoint) {
    EXPECT_THAT(pareto_front(std::vector<CostPoint>{{2, 0.1}, {2, 0.1}}), ElementsAre(true, true));
    EXPECT_THAT(pareto_front(std::vector<CostPoint>{{2, 0.0}}), ElementsAre(true));
    EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Front, DistanceIsTheCostOfTheCheapestThatIsAsAccurate) {
    EXPECT_DOUBLE_EQ(times_the_front(kPoints, 0), 1);
    EXPECT_DOUBLE_EQ(times_the_front(kPoints, 2), 1);
    EXPECT_DOUBLE_EQ(times_the_front(kPoints, 3), 2);  // 8 instead of 4
    EXPECT_DOUBLE_EQ(times_the_front(kPoints, 4), 2);  // 2 instead of 1
    EXPECT_DOUBLE_EQ(times_the_front(kPoints, 1), 1);  // as cheap as the best, only worse
}

TEST(Front, CostOfAnErrorLiesBetweenItsNeighboursOnTheFront) {
    // From (1, .1) to (4, .01) error falls by 10 while cost rises by 4: at a tenth's root, twice.
    EXPECT_NEAR(front_cost_at(kPoints, 0.1 / std::sqrt(10.0)), 2, 1e-12);
    EXPECT_DOUBLE_EQ(front_cost_at(kPoints, 0.01), 4);
    EXPECT_DOUBLE_EQ(front_cost_at(kPoints, 0.1), 1);
    EXPECT_LT(front_cost_at(kPoints, 0.005), 0);  // more accurate than any
    EXPECT_LT(front_cost_at(kPoints, 0.5), 0);    // less than any: no cost to name
    EXPECT_LT(front_cost_at({}, 0.1), 0);
}

TEST(Front, EqualCostPairIsTheOneWhoseErrorsDifferMost) {
    const std::vector<CostPoint> points{
        {1.0, 0.10}, {1.1, 0.30}, {1.2, 0.20}, {2.0, 0.45}, {5, 0.01}};
    const auto pair = equal_cost_pair(points);
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->better, 0u);
    EXPECT_EQ(pair->other, 1u);
}

TEST(Front, EqualErrorPairIsTheOneWhoseCostsDifferMost) {
    const std::vector<CostPoint> points{{1.0, 0.10}, {3.0, 0.11}, {7.0, 0.095}, {9.0, 0.2}};
    const auto pair = equal_error_pair(points);
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->better, 0u);
    EXPECT_EQ(pair->other, 2u);
}

TEST(Front, NoPairWhereNothingDiffersOrNothingCanBeSeen) {
    EXPECT_FALSE(equal_cost_pair(std::vector<CostPoint>{{1, 0.1}, {1, 0.11}}));
    EXPECT_FALSE(equal_cost_pair(std::vector<CostPoint>{{1, 1e-5}, {1, 1e-4}}));
    EXPECT_FALSE(equal_error_pair(std::vector<CostPoint>{{1, 0.1}}));
}

}  // namespace
}  // namespace opaline::bake
