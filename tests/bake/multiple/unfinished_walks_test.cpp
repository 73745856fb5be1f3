#include "bake/effects/multiple/unfinished_walks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace opaline::bake {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

WalkCounts lose(std::uint64_t lost, std::uint64_t endless, double unfinished) {
    WalkCounts counts;
    counts.walks = 1000;
    counts.lost = lost;
    counts.endless = endless;
    counts.ends.unfinished[0] = unfinished;
    counts.ends.left[0] = 1000 - unfinished;
    return counts;
}

TEST(UnfinishedWalks, OfALittleLightNothingIsSaid) {
    EXPECT_FALSE(describe_unfinished("Wax", {}));
    EXPECT_FALSE(describe_unfinished("Wax", lose(3, 0, 0.9)));
}

TEST(UnfinishedWalks, HowMuchLightWhyAndWhatIsDoneAboutItIsStated) {
    const auto holes = describe_unfinished("Wax", lose(30, 0, 16));
    ASSERT_TRUE(holes);
    EXPECT_EQ(holes->where, "material 'Wax'");
    EXPECT_THAT(holes->fault,
                AllOf(HasSubstr("of 1000 random walks 30 leave through holes of its mesh: 1.6 %"),
                      HasSubstr("as bright as the rest"), Not(HasSubstr("too often"))));
    EXPECT_EQ(holes->remedy, "close the surface");
    const auto closed = describe_unfinished("Wax", lose(0, 20, 9));
    ASSERT_TRUE(closed);
    EXPECT_THAT(closed->fault, AllOf(HasSubstr("20 scatter too often"), Not(HasSubstr("holes"))));
    EXPECT_THAT(closed->remedy, HasSubstr("--check-model"));
    const auto mostly_hole = describe_unfinished("Wax", lose(700, 0, 600));
    ASSERT_TRUE(mostly_hole);
    EXPECT_THAT(mostly_hole->fault, AllOf(HasSubstr("60.0 %"), HasSubstr("is missing")));
}

}  // namespace
}  // namespace opaline::bake
