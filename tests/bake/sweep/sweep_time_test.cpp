#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "bake/base/stage_log.h"
#include "bake/lab/sweep/finest.h"
#include "bake/lab/sweep/run_sweep.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

bool is_set_within(const TimeLimit& limit, double seconds) {
    const Clock::time_point start = Clock::now();
    while (!limit.flag()->load() && seconds_since(start) < seconds) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return limit.flag()->load();
}

TEST(TimeLimit, IsOverAfterItsTimeOrWithAnotherFlagAndEndsBeforeIt) {
    constexpr double kLong = 1e6, kSoon = 10;
    EXPECT_TRUE(is_set_within(TimeLimit(0.02, nullptr), kSoon));
    std::atomic<bool> outer = false;
    const TimeLimit limit(kLong, &outer);
    EXPECT_FALSE(limit.flag()->load());
    outer = true;
    EXPECT_TRUE(is_set_within(limit, kSoon));
}

// A ball of 10,242 vertices that a draft follows walks in for many seconds, while the predictions
// of this machine are wrong by a factor of a million.
TEST(SweepTime, BakesThatTakeLongerThanPredictedAreStoppedWhenTheTimeIsOver) {
    const formats::Scene scene = tests::make_translucent_scene(
        {tests::make_sphere(5)}, tests::make_grey_medium(200, 1e-3f, 1.5f));
    SweepOptions options;
    options.seconds = 1;
    options.bake.threads = 1;
    options.rates.kinds["all others"] = {1e-6, 1};
    const Clock::time_point start = Clock::now();
    const auto result = run_sweep(all_effects(), scene, options, {}, {});
    EXPECT_LT(seconds_since(start), 4 * options.seconds);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, formats::ErrorKind::usage) << "and no interruption";
}

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
