#include "bake/lab/sweep/finest.h"

#include <gtest/gtest.h>

namespace opaline::bake {
namespace {

PointRecord point(double error, double seconds, const char* choices = "") {
    PointRecord record;
    record.error.rms_relative = error;
    record.seconds = seconds;
    record.choices = choices;
    return record;
}

// What little time could pay for as a truth, 16 texels a side with all coefficients, may err more
// than a preset that was baked later.
TEST(Finest, NoOtherBakeErrsLess) {
    EXPECT_EQ(find_finest(std::vector{point(0.2, 1), point(0.05, 9), point(0.02, 4)}, ""), 2u);
    EXPECT_EQ(find_finest(std::vector{point(0.2, 1), point(0.01, 9), point(0.02, 4)}, ""), 1u);
}

TEST(Finest, OfEqualsTheCostliest) {
    EXPECT_EQ(find_finest(std::vector{point(0, 1), point(0, 3), point(0, 2)}, ""), 1u);
}

// A bake by another model errs less in its numbers, but what it differs by is no numerical error.
TEST(Finest, BakesOfOtherChoicesDoNotCount) {
    const std::vector points{point(0.2, 1, "walks"), point(0.01, 9, "dipole"),
                             point(0.1, 4, "walks")};
    EXPECT_EQ(find_finest(points, "walks"), 2u);
    EXPECT_EQ(find_finest(points, "dipole"), 1u);
}

}  // namespace
}  // namespace opaline::bake
