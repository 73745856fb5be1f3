#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bake/check/measure_error.h"

namespace opaline::bake {
namespace {

using ::testing::HasSubstr;

// The truth is known exactly: both errors are the same.
CheckedPair exact_pair(double error, double reference) {
    return {{error, error}, reference};
}

EffectCheck make_check(const char* effect, const char* reference, std::vector<CheckedPair> pairs) {
    EffectCheck check;
    check.effect = effect;
    check.reference = reference;
    check.pairs = std::move(pairs);
    return check;
}

const std::vector<std::string> kTwoLights{"white", "sun"};

TEST(SummaryOfChecks, RelatesRmsErrorsToTheRmsOfTheirOwnReference) {
    // Two receivers under two lights, of each of two effects.
    const std::vector<EffectCheck> checks{
        make_check("direct", "rays",
                   {exact_pair(3, 10), exact_pair(0, 20), exact_pair(4, 10), exact_pair(0, 20)}),
        make_check("single", "depths",
                   {exact_pair(0, 2), exact_pair(-1, 1), exact_pair(0, 2), exact_pair(1, 1)})};
    const ErrorReport report = summarise_checks(checks, kTwoLights, 0);
    EXPECT_DOUBLE_EQ(report.rms_relative, std::sqrt(27.0 / 1010));
    EXPECT_EQ(report.receivers_checked, 4u);
    ASSERT_EQ(report.by_effect.size(), 2u);
    EXPECT_EQ(report.by_effect[0].name, "direct");
    EXPECT_DOUBLE_EQ(report.by_effect[0].rms_relative, std::sqrt(25.0 / 1000));
    EXPECT_EQ(report.by_effect[1].name, "single");
    EXPECT_DOUBLE_EQ(report.by_effect[1].rms_relative, std::sqrt(2.0 / 10));
    ASSERT_EQ(report.by_light.size(), 2u);
    EXPECT_EQ(report.by_light[0].name, "white");
    EXPECT_DOUBLE_EQ(report.by_light[0].rms_relative, std::sqrt(25.0 / 208));
    EXPECT_EQ(report.by_light[1].name, "sun");
    EXPECT_DOUBLE_EQ(report.by_light[1].rms_relative, std::sqrt(2.0 / 802));
    // The largest of eight errors, over the RMS of eight references.
    EXPECT_DOUBLE_EQ(report.max_relative, 4 / std::sqrt(1010.0 / 8));
    EXPECT_DOUBLE_EQ(report.p95_relative, 3 / std::sqrt(1010.0 / 8));
    EXPECT_THAT(report.reference, HasSubstr("direct: rays; single: depths"));
    EXPECT_THAT(report.reference, HasSubstr("luminance under white, sun"));
}

TEST(SummaryOfChecks, CountsAnEffectInSeveralMaterialsAsOne) {
    const std::vector<EffectCheck> checks{
        make_check("single", "depths", {exact_pair(1, 2), exact_pair(0, 2)}),
        make_check("direct", "rays", {}),  // nothing was drawn of it
        make_check("single", "depths", {exact_pair(0, 2), exact_pair(2, 2)})};
    const ErrorReport report = summarise_checks(checks, kTwoLights, 0);
    ASSERT_EQ(report.by_effect.size(), 1u);
    EXPECT_EQ(report.by_effect[0].name, "single");
    EXPECT_DOUBLE_EQ(report.by_effect[0].rms_relative, std::sqrt(5.0 / 16));
    EXPECT_EQ(report.receivers_checked, 2u);
}

TEST(SummaryOfChecks, NothingCheckedOrNothingToErrByIsZero) {
    EXPECT_EQ(summarise_checks({}, kTwoLights, 0).receivers_checked, 0u);
    EXPECT_EQ(summarise_checks({}, kTwoLights, 0).rms_relative, 0);
    const std::vector<EffectCheck> black{
        make_check("direct", "rays", {exact_pair(0, 0), exact_pair(0, 0)})};
    const ErrorReport report = summarise_checks(black, kTwoLights, 0);
    EXPECT_EQ(report.rms_relative, 0);
    EXPECT_EQ(report.max_relative, 0);
    EXPECT_EQ(report.ci95[1], 0);
    EXPECT_EQ(report.receivers_checked, 1u);
}

TEST(BoundError, ReceiversThatErrAlikeLeaveNoIntervalAndOthersDo) {
    const std::vector<CheckedPair> alike(40, exact_pair(0.2, 1));
    std::vector<CheckedPair> differing;
    for (int i = 0; i < 40; ++i) {
        differing.push_back(exact_pair(i % 2 == 0 ? 0.1 : 0.3, 1));
    }
    for (const auto& bound : {bound_error, bound_stated_error}) {
        const ErrorBounds point = bound(alike, 1, 0);
        EXPECT_DOUBLE_EQ(point.lowest, 0.2);
        EXPECT_DOUBLE_EQ(point.highest, 0.2);
    }
    // The mean square of 40 values, half .01 and half .09, is .05 +- .0063.
    const ErrorBounds bounds = bound_error(differing, 1, 0);
    EXPECT_NEAR(bounds.lowest, std::sqrt(0.05 - 1.96 * 0.0063), 0.008);
    EXPECT_NEAR(bounds.highest, std::sqrt(0.05 + 1.96 * 0.0063), 0.008);
}

TEST(BoundError, StatedOneAllowsForTwoMoreLikeTheWorst) {
    std::vector<CheckedPair> pairs(30, exact_pair(0.01, 1));
    pairs.push_back(exact_pair(0.5, 1));
    const ErrorBounds plain = bound_error(pairs, 1, 0), stated = bound_stated_error(pairs, 1, 0);
    EXPECT_EQ(stated.rms, plain.rms);
    EXPECT_EQ(stated.lowest, plain.lowest);
    // 97.5 of 100 times one of 31 is drawn at most three times, three of 33 at most six times.
    EXPECT_NEAR(plain.highest, 0.5 * std::sqrt(3 / 31.0), 0.01);
    EXPECT_NEAR(stated.highest, 0.5 * std::sqrt(6 / 33.0), 0.02);
}

TEST(DrawEvenly, TakesOneFromEachOfAsManyEqualRuns) {
    for (const auto& [count, wanted] : {std::pair<std::size_t, std::size_t>{0, 0},
                                        {5, 5},
                                        {100, 16},
                                        {1083, 27},
                                        {100000, 1024}}) {
        const auto drawn = draw_evenly(count, wanted, RandomStage::held_back_receivers, 3);
        ASSERT_EQ(drawn.size(), wanted);
        for (std::size_t i = 0; i < wanted; ++i) {
            EXPECT_GE(drawn[i], count * i / wanted);
            EXPECT_LT(drawn[i], count * (i + 1) / wanted);
        }
    }
    EXPECT_EQ(draw_evenly(5, 16, RandomStage::held_back_receivers, 3).size(), 5u)
        << "all there are";
}

TEST(DrawEvenly, EveryOneIsAsLikely) {
    constexpr std::size_t kCount = 160, kWanted = 16, kSeeds = 4000;
    std::vector<int> times(kCount);
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        for (const std::uint32_t v :
             draw_evenly(kCount, kWanted, RandomStage::held_back_receivers, seed)) {
            ++times[v];
        }
    }
    // 400 +- 19 each; five standard deviations for 160 counts.
    for (std::size_t v = 0; v < kCount; ++v) {
        EXPECT_NEAR(times[v], 400, 95) << v;
    }
}

}  // namespace
}  // namespace opaline::bake
