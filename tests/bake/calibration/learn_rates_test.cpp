#include "bake/pipeline/calibration/rates_cache.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opaline::bake {
namespace {

StageReport ran(const char* name, double cpu_seconds) {
    StageReport report;
    report.name = name;
    report.seconds = 100;  // the machine was busy
    report.cpu_seconds = cpu_seconds;
    return report;
}

StageCost predicted(const char* name, const char* kind, double work) {
    return {name, kind, work, 0};
}

TEST(LearnRates, FirstBakeOfAKindTeachesWhatItsStagesTook) {
    StageRates rates;
    const StageCost stages[] = {predicted("rows of 'a'", "rows", 2),
                                predicted("rows of 'b'", "rows", 4),
                                predicted("self-check", "self-check", 1)};
    learn_rates(stages, {ran("rows of 'a'", 1), ran("rows of 'b'", 8), ran("self-check", 3)},
                rates);
    EXPECT_DOUBLE_EQ(rates.factor("rows"), 1.5) << "9 s of the 6 s of both";
    EXPECT_DOUBLE_EQ(rates.factor("self-check"), 3);
}

TEST(LearnRates, LaterBakesMoveItByTheGeometricMeanAndNeverLessThanAnEighth) {
    StageRates rates;
    const StageCost stage = predicted("rows", "rows", 1);
    learn_rates({&stage, 1}, {ran("rows", 1)}, rates);
    learn_rates({&stage, 1}, {ran("rows", 4)}, rates);
    EXPECT_NEAR(rates.factor("rows"), 2, 1e-12);
    for (int i = 0; i < 30; ++i) {
        learn_rates({&stage, 1}, {ran("rows", 2)}, rates);
    }
    learn_rates({&stage, 1}, {ran("rows", 4)}, rates);
    EXPECT_NEAR(rates.factor("rows"), 2 * std::pow(2, 1.0 / 8), 1e-9);
    EXPECT_EQ(rates.kinds.at("rows").bakes, 33u);
}

TEST(LearnRates, KindThatIsNotKnownTakesTheMachinesSpeed) {
    StageRates rates;
    EXPECT_EQ(rates.factor("rows"), 1);
    const StageCost stages[] = {predicted("a", "a", 1), predicted("b", "b", 1)};
    learn_rates(stages, {ran("a", 2), ran("b", 8)}, rates);
    EXPECT_NEAR(rates.factor("rows"), 4, 1e-12);
}

TEST(LearnRates, ShortStageTeachesLess) {
    StageRates rates;
    const StageCost stage = predicted("self-check", "self-check", 0.0025);
    learn_rates({&stage, 1}, {ran("self-check", 0.025)}, rates);
    EXPECT_NEAR(rates.factor("self-check"), std::pow(10, 0.25), 1e-9);
}

// Test lights are computed at the first bake and read at the next.
TEST(LearnRates, WhatTheMachineIsNotTheCauseOfTeachesNothing) {
    StageRates rates;
    const StageCost stages[] = {predicted("test lights", "test lights", 0.005),
                                predicted("plan", "plan", 0.001), predicted("none", "none", 0),
                                predicted("left out", "left out", 1)};
    learn_rates(stages,
                {ran("test lights", 4), ran("plan", 0.003), ran("none", 1), ran("unknown", 1)},
                rates);
    EXPECT_TRUE(rates.kinds.empty());
}

// Its rounds have the same stages; those of the knobs of the file come last.
TEST(LearnRates, LastRoundOfAPilotIsWhatThePredictionIsOf) {
    StageRates rates;
    const StageCost stages[] = {predicted("pilot", "pilot", 1), predicted("samples", "samples", 1)};
    learn_rates(stages, {ran("samples", 19), ran("pilot", 9), ran("pilot", 3), ran("samples", 2)},
                rates);
    EXPECT_DOUBLE_EQ(rates.factor("samples"), 2);
    EXPECT_DOUBLE_EQ(rates.factor("pilot"), 3);
}

}  // namespace
}  // namespace opaline::bake
