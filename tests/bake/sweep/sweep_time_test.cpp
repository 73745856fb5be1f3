#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "bake/accuracy/sweep/run_sweep.h"
#include "bake/accuracy/sweep/time_limit.h"
#include "bake/base/stage_log.h"
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

// A ball of 2000 mean free paths without absorption: a path inside has some million events, so that
// a first look at the truth takes far longer than the whole sweep may.
TEST(SweepTime, TruthsAndBakesEndWithTheTime) {
    const formats::Scene scene = tests::make_translucent_scene(
        {tests::make_sphere(1)}, tests::make_grey_medium(2000, 1e-4f, 1.5f));
    SweepOptions options;
    options.seconds = 2;
    options.bake.threads = 1;
    const Clock::time_point start = Clock::now();
    const auto result = run_sweep(all_effects(), scene, options, {}, {});
    EXPECT_LT(seconds_since(start), 2 * options.seconds);
    if (result) {
        EXPECT_FALSE(result->skipped.empty()) << "what was left out is named";
    } else {
        EXPECT_EQ(result.error().kind, formats::ErrorKind::usage) << "nor is it an interruption";
    }
}

}  // namespace
}  // namespace opaline::bake
