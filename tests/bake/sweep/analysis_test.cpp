#include "bake/lab/sweep/analysis.h"

#include <gmock/gmock.h>

#include <cmath>

#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/single/single_knobs.h"

namespace opaline::bake {
namespace {

using ::testing::ElementsAre;

PointRecord rung(Ladder ladder, double value, double luminance) {
    PointRecord record;
    record.point = {"rung " + std::to_string(value), {{ladder, value}}, {}};
    record.luminance = {luminance};
    record.seconds = value;
    record.bytes = 1;
    return record;
}

// Luminance 1 + 8 / s: the error against s = 64000 falls as 1 / s, and next to it faster.
TEST(Analysis, RateIsMeasuredWithinTheLadderWhateverElseErrs) {
    SweepResult result;
    for (const double s : {4000.0, 1000.0, 64000.0, 16000.0, 32000.0}) {
        result.points.push_back(rung(ladder_of(kSamples), s, 1 + 8 / s));
    }
    // The truth is elsewhere: another knob is what makes the ladder's common error.
    result.points.push_back(rung(Ladders::grid, 1, 0.5));
    result.truth = 5;
    result.subject.knobs = {&kSamples};
    const SweepAnalysis analysis = analyse_sweep(result);
    ASSERT_EQ(analysis.fits.size(), 1u);
    const LadderFit& fit = analysis.fits[0];
    EXPECT_EQ(fit.ladder, ladder_of(kSamples));
    EXPECT_EQ(fit.against, "rung 64000.000000");
    ASSERT_TRUE(fit.fit);
    EXPECT_NEAR(fit.fit->slope, -1, 0.1);
    EXPECT_THAT(fit.fit->used, ElementsAre(1000, 4000, 16000));  // 32000 is too near
    EXPECT_EQ(fit.rungs.size(), 4u);
}

TEST(Analysis, ToleranceZeroIsTheFinestAndTermsCountAsDegrees) {
    SweepResult result;
    for (const double e : {0.0, 1e-3, 1e-2, 1e-1}) {
        result.points.push_back(rung(ladder_of(kEpsilon), e, 1 + e));
    }
    result.mean_cosine = 0.5;
    for (const int degree : {0, 1, 2, 3, 4}) {
        result.points.push_back(
            rung(ladder_of(kPhaseTerms), (degree + 1) * (degree + 1), 1 + std::pow(0.5, degree)));
    }
    result.subject.knobs = {&kEpsilon, &kPhaseTerms};
    const SweepAnalysis analysis = analyse_sweep(result);
    ASSERT_EQ(analysis.fits.size(), 2u);
    EXPECT_NEAR(analysis.fits[0].fit->slope, 1, 1e-9);
    EXPECT_THAT(analysis.fits[1].fit->used, ElementsAre(0, 1, 2, 3));
    EXPECT_NEAR(analysis.fits[1].theory.rate, std::log(0.5), 1e-12);
    EXPECT_NEAR(analysis.fits[1].fit->slope, std::log(0.5), 0.25);
}

TEST(Analysis, ErrorsAgreeWhereIntervalsMeetAndTheFinestIsNotAsked) {
    SweepResult result;
    for (const double high : {0.1, 0.3, 0.3}) {
        PointRecord record = rung(Ladders::grid, 1, 1);
        record.error.ci95[0] = 0.2;
        record.error.ci95[1] = 0.4;
        record.against_finest.ci95[1] = high;
        record.finest = 2;
        result.points.push_back(record);
    }
    result.truth = 2;
    const SweepAnalysis analysis = analyse_sweep(result);
    EXPECT_EQ(analysis.checks, 2u);
    EXPECT_EQ(analysis.checks_agreeing, 1u);
}

// Two ways to compute: the dipole is quicker, and stops at 30 %.
TEST(Analysis, EachWayToComputeHasAFrontOfItsOwnInTimeAndTotalError) {
    struct Bake {
        const char* choices;
        double seconds, numerical, total;
    };
    SweepResult result;
    for (const Bake& bake :
         {Bake{"dipole", 1, 0.1, 0.32}, Bake{"walks", 2, 0.2, 0.21}, Bake{"dipole", 4, 0.01, 0.3},
          Bake{"walks", 8, 0.02, 0.03}, Bake{"dipole", 3, 0.15, 0.33}}) {
        PointRecord record = rung(Ladders::grid, 1, 1);
        record.choices = bake.choices;
        record.seconds = bake.seconds;
        record.error.rms_relative = bake.numerical;
        record.total.rms_relative = bake.total;
        result.points.push_back(record);
    }
    result.truth = 2;
    const SweepAnalysis analysis = analyse_sweep(result);
    ASSERT_EQ(analysis.lines.size(), 2u);
    EXPECT_EQ(analysis.lines[0].choices, "dipole");
    EXPECT_THAT(analysis.lines[0].front, ElementsAre(0, 2));
    EXPECT_EQ(analysis.lines[1].choices, "walks");
    EXPECT_THAT(analysis.lines[1].front, ElementsAre(1, 3));
    EXPECT_TRUE(analysis.standing[1].on_front_time) << "of the bakes by walks";
    EXPECT_FALSE(analysis.standing[4].on_front_time);
    EXPECT_FALSE(analysis.standing[4].on_front_total);
}

TEST(StageGroups, AddUpToTheWholeAndStagesOfOneGroupStandTogether) {
    const StageLog stages{{"bodies", kPreparationGroup, 1, 0, 0},
                          {"samples of material 'Wax'", "multiple: samples", 2, 0, 0},
                          {"rows of 'a'", "multiple: rows", 8, 0, 0},
                          {"rows of 'b'", "direct: rows", 16, 0, 0},
                          {"rows of 'c'", "multiple: rows", 32, 0, 0}};
    const StageGroups groups = group_stages(stages, 256);
    ASSERT_EQ(groups.size(), 4u);
    EXPECT_EQ(seconds_of(groups, kPreparationGroup), 256 - 58) << "and what is between stages";
    EXPECT_EQ(seconds_of(groups, "multiple: rows"), 40);
    EXPECT_EQ(seconds_of(groups, "direct: rows"), 16);
    EXPECT_EQ(seconds_of(groups, "multiple: samples"), 2);
    EXPECT_EQ(seconds_of(groups, "no such group"), 0);
    double sum = 0;
    for (const GroupSeconds& group : groups) {
        sum += group.seconds;
    }
    EXPECT_EQ(sum, 256);
}

}  // namespace
}  // namespace opaline::bake
