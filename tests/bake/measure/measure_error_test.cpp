#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bake/check/error_warnings.h"
#include "bake/check/measure_error.h"
#include "bake/check/stored_luminance.h"

namespace opaline::bake {
namespace {

const std::array<std::string, 2> kLights{"white", "sun"};

// `points` points of truth 1 that err by `error` under both lights.
EffectCheck check_of(std::string effect, std::size_t points, double error, bool between,
                     std::uint32_t primitive = 0) {
    EffectCheck check;
    check.effect = std::move(effect);
    check.reference = "what is";
    check.between = between;
    for (std::size_t i = 0; i < points; ++i) {
        append_point({primitive, {{{error, error}, 1}, {{error, error}, 1}}, 7}, check);
    }
    return check;
}

TEST(SummariseChecks, StatesBothPlacesAndTheWhole) {
    EffectCheck worst = check_of("direct", 10, 0.4, true, 3);
    append_point({1, {{{0.1, 0.1}, 1}, {{0.1, 0.1}, 1}}, 7}, worst);
    const std::array<EffectCheck, 3> checks{check_of("direct", 20, 0.01, false),
                                            check_of("multiple", 20, 0.02, false), worst};
    const ErrorReport report = summarise_checks(checks, kLights, 0);
    EXPECT_NEAR(report.at_receivers.rms_relative, std::sqrt((1e-4 + 4e-4) / 2), 1e-12);
    EXPECT_NEAR(report.between.rms_relative, std::sqrt((10 * 0.16 + 0.01) / 11), 1e-12);
    EXPECT_NEAR(report.rms_relative, std::sqrt((20 * 5e-4 + 1.61) / 51), 1e-12);
    EXPECT_LT(report.between.ci95[0], report.between.rms_relative);
    EXPECT_NEAR(report.between.ci95[1], 0.4, 1e-9);
    EXPECT_EQ(report.receivers_checked, 40u);
    EXPECT_EQ(report.points_between_checked, 11u);
    EXPECT_EQ(report.worst_between, 3u);
    ASSERT_EQ(report.at_receivers.by_effect.size(), 2u);
    EXPECT_EQ(report.at_receivers.by_effect[1].name, "multiple");
    EXPECT_NEAR(report.at_receivers.by_effect[1].rms_relative, 0.02, 1e-12);
    ASSERT_EQ(report.between.by_effect.size(), 1u);
    ASSERT_EQ(report.by_light.size(), 2u);
    EXPECT_NEAR(report.by_light[1].rms_relative, report.rms_relative, 1e-12);
    EXPECT_EQ(worst.rays, 77u);
}

class MeasuredErrorWarnings : public ::testing::Test {
  protected:
    MeasuredErrorWarnings() {
        scene.primitives.resize(4);
        scene.primitives[3].name = "floor";
    }

    std::vector<formats::Diagnostic> describe(double at_receivers, double between,
                                              bool is_bounded = false) const {
        const std::array<EffectCheck, 2> checks{check_of("direct", 20, at_receivers, false),
                                                check_of("direct", 20, between, true, 3)};
        return describe_measured_error(scene, knobs, summarise_checks(checks, kLights, 0),
                                       is_bounded);
    }

    formats::Scene scene;
    Knobs knobs;
};

TEST_F(MeasuredErrorWarnings, LargeErrorsOfAPresetAreSaidAndSmallOnesAreNot) {
    EXPECT_TRUE(describe(0.09, 0.09).empty());
    const auto vertices = describe(0.11, 0.09);
    ASSERT_EQ(vertices.size(), 1u);
    EXPECT_THAT(vertices[0].fault, ::testing::HasSubstr("at its vertices"));
    EXPECT_THAT(vertices[0].remedy, ::testing::HasSubstr("--coefficients"));
    const auto surface = describe(0.01, 0.3);
    ASSERT_EQ(surface.size(), 1u);
    EXPECT_THAT(surface[0].where, ::testing::HasSubstr("floor"));
    EXPECT_THAT(surface[0].fault, ::testing::HasSubstr("30 %"));
    EXPECT_THAT(surface[0].remedy, ::testing::HasSubstr("more vertices"));
    EXPECT_EQ(describe(0.87, 0.99).size(), 2u);
}

TEST_F(MeasuredErrorWarnings, ALargerLimitOfReceiversIsAdvisedWhereALimitEndedRefinement) {
    knobs.refine.mode = RefineChoice::Mode::where_light_changes;
    const auto limited = ::testing::HasSubstr("--max-receivers");
    EXPECT_THAT(describe(0.01, 0.3, true).at(0).remedy, limited);
    EXPECT_THAT(describe(0.01, 0.3, false).at(0).remedy, ::testing::Not(limited));
}

TEST_F(MeasuredErrorWarnings, DraftsMayErrByTwiceAsMuch) {
    knobs.quality = Quality::draft;
    EXPECT_TRUE(describe(0.19, 0.19).empty());
    EXPECT_EQ(describe(0.21, 0.21).size(), 2u);
}

TEST_F(MeasuredErrorWarnings, WithATargetThePointsBetweenMustMeetItToo) {
    knobs.error_target = 0.02;
    EXPECT_TRUE(describe(0.01, 0.019).empty());
    const auto missed = describe(0.01, 0.03);
    ASSERT_EQ(missed.size(), 1u);
    EXPECT_THAT(missed[0].fault, ::testing::HasSubstr("2 % asked for"));
    // The pilot explains why receivers miss it.
    EXPECT_TRUE(describe(0.5, 0.01).empty());
}

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

RowLayout make_layout(std::uint32_t harmonics, bool separate) {
    RowLayout layout;
    layout.translucent = true;
    layout.constant = true;
    layout.harmonics = harmonics;
    layout.separate = separate;
    return layout;
}

// Separate rows without harmonics were written one past their end: found by the address sanitizer.
TEST(ViewOfRows, HasOneFactorForEachRowWhateverTheLayout) {
    constexpr float kY0 = 0.2820948f, kY1 = 0.4886025f;
    const glm::vec3 up(0, 1, 0);
    EXPECT_EQ(view_of_rows(make_layout(0, false), up), std::vector<float>({1}));
    RowLayout sheet;
    sheet.sheet = true;
    EXPECT_EQ(view_of_rows(sheet, up), std::vector<float>({1, 0}));
    EXPECT_EQ(view_of_rows(sheet, up, true), std::vector<float>({0, 1})) << "from behind";
    EXPECT_EQ(view_of_rows(make_layout(0, true), up), std::vector<float>({1}));
    EXPECT_EQ(view_of_rows(make_layout(1, true), up).size(), 2u);
    const std::vector<float> apart = view_of_rows(make_layout(4, true), up);
    ASSERT_EQ(apart.size(), 5u);
    EXPECT_EQ(apart[0], 1);
    EXPECT_NEAR(apart[1], kY0, 1e-6);
    EXPECT_NEAR(apart[2], kY1, 1e-6);
}

TEST(ViewOfRows, OneHarmonicOfOneEffectStandsAmongTheFourOfAnother) {
    RowLayout layout = make_layout(1, false);
    layout.view_harmonics = 4;
    EXPECT_EQ(layout.terms(), 4u);
    const std::vector<float> h = view_of_rows(layout, {0, 1, 0});
    ASSERT_EQ(h.size(), 4u);
    EXPECT_NEAR(static_cast<double>(h[0]), layout.view_of_constant(), 1e-6);
    EXPECT_NEAR(h[1], 0.4886025f, 1e-6);
}

}  // namespace

}  // namespace opaline::bake
