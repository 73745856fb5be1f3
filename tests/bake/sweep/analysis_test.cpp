#include <gmock/gmock.h>

#include <cmath>

#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/single/single_knobs.h"
#include "bake/lab/sweep/analysis.h"

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

using ::testing::IsEmpty;

TEST(Slopes, PowerLawIsFoundExactly) {
    std::vector<Convergence> rungs;
    for (const double n : {8.0, 16.0, 32.0, 64.0}) {
        rungs.push_back({n, 3 * std::pow(n, -1.5)});
    }
    const auto fit = fit_slope(rungs, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, -1.5, 1e-12);
    EXPECT_NEAR(std::exp(fit->intercept), 3, 1e-12);
    EXPECT_NEAR(fit->standard_error, 0, 1e-7);
    EXPECT_THAT(fit->saturated, IsEmpty());
}

// Scatter of (+d, -d, -d, +d) around a line through equally spaced abscissae does not turn it, and
// leaves a standard error of sqrt(4 d^2 / 2 / sum (x - mean)^2) = d sqrt(2 / 5) / step.
TEST(Slopes, StandardErrorIsThatOfLeastSquares) {
    const double d = 0.1, step = std::log(2.0);
    std::vector<Convergence> rungs;
    const double sign[] = {1, -1, -1, 1};
    for (int i = 0; i < 4; ++i) {
        rungs.push_back({std::exp(i * step), std::exp(-2 * i * step + sign[i] * d)});
    }
    const auto fit = fit_slope(rungs, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, -2, 1e-12);
    EXPECT_NEAR(fit->standard_error, d * std::sqrt(0.4) / step, 1e-12);
}

TEST(Slopes, RungsOnTheFloorDoNotFlattenTheSlope) {
    const auto fit = fit_slope(
        std::vector<Convergence>{{1, 1.0}, {2, 0.5}, {4, 0.25}, {8, 0.249}, {16, 0.25}}, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, -1, 1e-12);
    EXPECT_THAT(fit->used, ElementsAre(1, 2, 4));
    EXPECT_THAT(fit->saturated, ElementsAre(8, 16));
}

TEST(Slopes, ToleranceThatFallsTakesTheErrorWithIt) {
    const auto fit = fit_slope(
        std::vector<Convergence>{{1e-1, 2e-2}, {1e-2, 2e-3}, {1e-3, 2e-4}, {0, 1e-9}}, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 1, 1e-12);
    EXPECT_THAT(fit->used, ElementsAre(1e-1, 1e-2, 1e-3));  // 0 has no logarithm
}

TEST(Slopes, SemiLogarithmicFitFindsTheAnisotropy) {
    std::vector<Convergence> rungs;
    for (int degree = 0; degree < 4; ++degree) {
        rungs.push_back({static_cast<double>(degree), 0.3 * std::pow(0.6, degree + 1)});
    }
    const auto fit = fit_slope(rungs, true);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(std::exp(fit->slope), 0.6, 1e-12);
    EXPECT_NEAR(fit->slope, convergence_theory(ladder_of(kPhaseTerms), 0.6)->rate, 1e-12);
}

TEST(Slopes, NothingIsClaimedOfLessThanTwoPoints) {
    EXPECT_FALSE(fit_slope({}, false));
    EXPECT_FALSE(fit_slope(std::vector<Convergence>{{1, 0.5}}, false));
    EXPECT_FALSE(fit_slope(std::vector<Convergence>{{1, 0.5}, {2, 0.5}}, false));
    EXPECT_FALSE(fit_slope(std::vector<Convergence>{{1, 0.0}, {2, 0.0}}, false));
    EXPECT_EQ(fit_slope(std::vector<Convergence>{{1, 0.5}, {2, 0.25}}, false)->standard_error, 0);
}

TEST(Slopes, SwitchesAndIsotropicPhaseFunctionsHaveNoRate) {
    EXPECT_FALSE(convergence_theory(Ladders::exact_rays, 0.5));
    EXPECT_FALSE(convergence_theory(Ladders::preset, 0.5));
    EXPECT_FALSE(convergence_theory(ladder_of(kPhaseTerms), 0));
}

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
