#include "bake/sweep/analysis.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

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
        result.points.push_back(rung(Ladder::samples, s, 1 + 8 / s));
    }
    // The truth is elsewhere: another knob is what makes the ladder's common error.
    result.points.push_back(rung(Ladder::grid, 1, 0.5));
    result.truth = 5;
    const SweepAnalysis analysis = analyse_sweep(result);
    ASSERT_EQ(analysis.fits.size(), 1u);
    const LadderFit& fit = analysis.fits[0];
    EXPECT_EQ(fit.ladder, Ladder::samples);
    EXPECT_EQ(fit.against, "rung 64000.000000");
    ASSERT_TRUE(fit.fit);
    EXPECT_NEAR(fit.fit->slope, -1, 0.1);
    EXPECT_THAT(fit.fit->used, ElementsAre(1000, 4000, 16000));  // 32000 is too near
    EXPECT_EQ(fit.rungs.size(), 4u);
}

TEST(Analysis, ToleranceZeroIsTheFinestAndTermsCountAsDegrees) {
    SweepResult result;
    for (const double e : {0.0, 1e-3, 1e-2, 1e-1}) {
        result.points.push_back(rung(Ladder::tolerance, e, 1 + e));
    }
    result.mean_cosine = 0.5;
    for (const int degree : {0, 1, 2, 3, 4}) {
        result.points.push_back(
            rung(Ladder::phase_terms, (degree + 1) * (degree + 1), 1 + std::pow(0.5, degree)));
    }
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
        PointRecord record = rung(Ladder::grid, 1, 1);
        record.error.ci95[0] = 0.2;
        record.error.ci95[1] = 0.4;
        record.against_finest.ci95[1] = high;
        result.points.push_back(record);
    }
    result.truth = 2;
    const SweepAnalysis analysis = analyse_sweep(result);
    EXPECT_EQ(analysis.checks, 2u);
    EXPECT_EQ(analysis.checks_agreeing, 1u);
}

TEST(StageGroups, AddUpToTheWholeAndTellMediaFromOpaqueSurfaces) {
    BakeResult bake;
    bake.asset.primitives.resize(2);
    bake.asset.primitives[0].shading = formats::Shading::translucent;
    bake.asset.primitives[1].shading = formats::Shading::diffuse;
    bake.stages = {{"bodies", 1, 0, 0},
                   {"samples of material 'Wax'", 2, 0, 0},
                   {"light maps of material 'Wax'", 4, 0, 0},
                   {"rows of 'a'", 8, 0, 0},
                   {"rows of 'b'", 16, 0, 0},
                   {"openness", 32, 0, 0},
                   {"self-check", 64, 0, 0},
                   {"something new", 128, 0, 0}};
    bake.seconds_total = 256;
    const StageGroups groups = group_stages(bake);
    EXPECT_THAT(groups, ElementsAre(130, 16, 2, 4, 8, 32, 64));
    EXPECT_EQ(std::accumulate(groups.begin(), groups.end(), 0.0), 256);
    EXPECT_EQ(groups.size(), stage_group_names().size());
}

}  // namespace
}  // namespace opaline::bake
