#include <stdlib.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "bake/pipeline/calibration/rates_cache.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

const MachineKey kMachine{"Abacus 3000", 7, "1.2.3"};

// With many decimals.
StageRates odd_rates() {
    return {{{"rows + direct", {1.0 / 3, 7}}, {"self-check", {std::sqrt(2.0), 1}}}};
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(RatesCache, GivesBackWhatWasKeptToTheLastBit) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "not" / "there" / "calibration.json";
    EXPECT_FALSE(read_rates(file, kMachine));
    ASSERT_TRUE(write_rates(file, kMachine, odd_rates()));
    const auto rates = read_rates(file, kMachine);
    ASSERT_TRUE(rates);
    EXPECT_EQ(rates->kinds, odd_rates().kinds);
    // Nothing else is left behind, and the file can be replaced.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 1);
    ASSERT_TRUE(write_rates(file, kMachine, {}));
    EXPECT_TRUE(read_rates(file, kMachine)->kinds.empty());
}

TEST(RatesCache, HoldsForOneProcessorThreadCountAndVersionOnly) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "calibration.json";
    ASSERT_TRUE(write_rates(file, kMachine, odd_rates()));
    EXPECT_TRUE(read_rates(file, kMachine));
    EXPECT_FALSE(read_rates(file, {"Abacus 4000", 7, "1.2.3"}));
    EXPECT_FALSE(read_rates(file, {"Abacus 3000", 8, "1.2.3"}));
    EXPECT_FALSE(read_rates(file, {"Abacus 3000", 7, "1.2.4"}));
}

TEST(RatesCache, ProcessorNamesThatAreNotUtf8AreNames) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "calibration.json";
    const MachineKey odd{"\xff\xfe", 1, "1"};
    ASSERT_TRUE(write_rates(file, odd, odd_rates()));
    EXPECT_TRUE(read_rates(file, odd));
}

TEST(RatesCache, DamagedFilesAreAsGoodAsNone) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "calibration.json";
    ASSERT_TRUE(write_rates(file, kMachine, odd_rates()));
    const std::string whole = read_text(file);
    // Every byte is needed, except the last brace and line break.
    for (std::size_t size = 0; size + 2 < whole.size(); size += 7) {
        std::ofstream(file, std::ios::binary) << whole.substr(0, size);
        EXPECT_FALSE(read_rates(file, kMachine)) << size;
    }
    const std::size_t name = whole.find("factor"), number = whole.find(':', name) + 2;
    for (const char* bad : {"-1", "0", "null", "\"fast\"", "[]", "1e999"}) {
        std::string text = whole;
        text.replace(number, text.find(',', number) - number, bad);
        std::ofstream(file, std::ios::binary) << text;
        EXPECT_FALSE(read_rates(file, kMachine)) << bad;
    }
    std::string renamed = whole;
    renamed[name] = 'F';
    std::ofstream(file, std::ios::binary) << renamed;
    EXPECT_FALSE(read_rates(file, kMachine));
    std::ofstream(file, std::ios::binary) << "[]";
    EXPECT_FALSE(read_rates(file, kMachine));
    EXPECT_FALSE(read_rates(folder.path(), kMachine));  // a folder
}

TEST(RatesCache, FolderThatCannotBeMadeIsAnErrorToTheCaller) {
    const tests::TemporaryFolder folder;
    std::ofstream(folder.path() / "file") << "in the way";
    const auto status = write_rates(folder.path() / "file" / "calibration.json", kMachine, {});
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().kind, formats::ErrorKind::resource);
}

TEST(RatesCache, StandsInTheUsersCacheFolder) {
    ::setenv("HOME", "/home/somebody", 1);
    ::setenv("XDG_CACHE_HOME", "/fast/cache", 1);
    EXPECT_EQ(rates_path(), "/fast/cache/opaline/calibration.json");
    // Relative ones are to be ignored, says the XDG specification.
    for (const char* unfit : {"", "cache"}) {
        ::setenv("XDG_CACHE_HOME", unfit, 1);
        EXPECT_EQ(rates_path(), "/home/somebody/.cache/opaline/calibration.json");
    }
    ::unsetenv("XDG_CACHE_HOME");
    EXPECT_EQ(rates_path(), "/home/somebody/.cache/opaline/calibration.json");
    ::unsetenv("HOME");
    EXPECT_TRUE(rates_path().empty());
}

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
