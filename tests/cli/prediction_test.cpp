#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bake/pipeline/calibration/rates_cache.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// All kinds take so much longer than the constants say.
void keep(const std::string& cache, double factor) {
    ASSERT_TRUE(bake::write_rates(cache + "/opaline/calibration.json", bake::this_machine(),
                                  {{{"rows", {factor, 1}}}}));
}

TEST(Prediction, NothingIsMeasuredAtFirstUse) {
    SmallScene small;
    const std::string cache = small.path("cache");
    const Outcome plan = run_with_cache(cache, {"plan", small.scene()});
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    EXPECT_EQ(plan.err, "");
    EXPECT_THAT(plan.out, HasSubstr("predicted: "));
    EXPECT_FALSE(std::filesystem::exists(cache));
}

TEST(Prediction, BakeTeachesTheNextPlanOfItsKind) {
    SmallScene small;
    const std::string cache = small.path("cache"), file = cache + "/opaline/calibration.json";
    keep(cache, 1000);  // a slow machine: what the bake teaches is less by far
    const Arguments plan{"plan", small.scene(), "--quality", "draft", "--json"};
    const auto total = [&] {
        return Json::parse(run_with_cache(cache, plan).out)
            .at("predicted_seconds_total")
            .get<double>();
    };
    const double before = total();
    ASSERT_EQ(run_with_cache(
                  cache, {"bake", small.scene(), "-o", small.path("a.opal"), "--quality", "draft"})
                  .exit_code,
              0);
    const auto rates = bake::read_rates(file, bake::this_machine());
    ASSERT_TRUE(rates);
    EXPECT_GT(rates->kinds.size(), 1u);
    EXPECT_LT(total(), 0.5 * before);
    // What another machine left there is of no use, and replaced.
    bake::MachineKey other = bake::this_machine();
    other.threads += 1;
    ASSERT_TRUE(bake::write_rates(file, other, {}));
    ASSERT_EQ(run_with_cache(
                  cache, {"bake", small.scene(), "-o", small.path("a.opal"), "--quality", "draft"})
                  .exit_code,
              0);
    EXPECT_TRUE(bake::read_rates(file, bake::this_machine()));
}

TEST(Prediction, CacheThatIsDamagedOrCannotBeWrittenIsNoError) {
    SmallScene small;
    const std::string damaged = small.path("cache");
    std::filesystem::create_directories(damaged + "/opaline");
    std::ofstream(damaged + "/opaline/calibration.json") << "{\"machine\": 3";
    const std::string report = small.path("r.json");
    for (const std::string& cache : {damaged, small.scene() + "/no-folder"}) {
        const Outcome bake =
            run_with_cache(cache, {"bake", small.scene(), "-o", small.path("a.opal"), "--quality",
                                   "draft", "--report", report});
        EXPECT_EQ(bake.exit_code, 0) << bake.err;
        EXPECT_THAT(bake.err, Not(HasSubstr("error: ")));
        EXPECT_THAT(bake.err, Not(HasSubstr("calibration")));
        const Json json = Json::parse(read_text(report));
        EXPECT_THAT(json.at("calibration").get<std::string>(), HasSubstr("constants"));
        EXPECT_GT(json.at("predicted_seconds_total").get<double>(), 0);
    }
}

TEST(Prediction, PlanTellsStagesAndTotalInJsonAndAtTheFootOfItsTable) {
    SmallScene small;
    keep(small.path("cache"), 2);
    const Outcome plan = run_with_cache(small.path("cache"), {"plan", small.scene(), "--json",
                                                              "--threads", "2", "--refine", "off"});
    ASSERT_EQ(plan.exit_code, 0) << plan.err;
    const Json json = Json::parse(plan.out);
    const auto total = json.at("predicted_seconds_total").get<double>();
    double stages = 0, effects = json.at("predicted_seconds_shared").get<double>();
    for (const Json& stage : json.at("stages")) {
        EXPECT_FALSE(stage.at("name").get<std::string>().empty());
        stages += stage.at("predicted_seconds").get<double>();
    }
    double bytes = json.at("predicted_bytes_shared").get<double>();
    for (const Json& entry : json.at("plan")) {
        effects += entry.at("predicted_seconds").get<double>();
        bytes += entry.at("predicted_bytes").get<double>();
    }
    EXPECT_GT(total, 0);
    EXPECT_NEAR(stages, total, 1e-9 * total);
    EXPECT_NEAR(effects, total, 1e-9 * total);
    EXPECT_EQ(bytes, json.at("predicted_bytes_total").get<double>());
    EXPECT_EQ(json.at("receivers"), 8);
    const Outcome table = run_with_cache(
        small.path("cache"), {"plan", small.scene(), "--threads", "1", "--refine", "off"});
    EXPECT_THAT(table.out, HasSubstr("\nthe rest "));
    EXPECT_THAT(table.out,
                ::testing::ContainsRegex("\npredicted: .* on 1 thread, .*, 8 receivers"));
}

TEST(Prediction, ReportSetsPredictedBesideMeasuredStageByStage) {
    SmallScene small;
    keep(small.path("cache"), 2);
    const std::string report = small.path("r.json");
    ASSERT_EQ(
        run_with_cache(small.path("cache"), {"bake", small.scene(), "-o", small.path("a.opal"),
                                             "--quality", "draft", "--report", report})
            .exit_code,
        0);
    const Json json = Json::parse(read_text(report));
    double sum = 0;
    for (const Json& stage : json.at("stages")) {
        sum += stage.at("predicted_seconds").get<double>();
        EXPECT_GE(stage.at("cpu_seconds").get<double>(), 0);
    }
    const auto total = json.at("predicted_seconds_total").get<double>();
    EXPECT_GT(total, 0);
    EXPECT_NEAR(sum, total, 1e-9 * total);
    EXPECT_THAT(json.at("calibration").get<std::string>(), HasSubstr("read from"));
}

// Nothing is chosen by predicted seconds, and the file tells none.
TEST(Prediction, FileDoesNotDependOnHowFastTheMachineIs) {
    SmallScene small;
    std::vector<std::string> files;
    for (const double factor : {1.0, 1e6}) {
        const std::string cache = small.path("cache" + std::to_string(files.size()));
        keep(cache, factor);
        const std::string out = small.path("a.opal");
        ASSERT_EQ(
            run_with_cache(cache, {"bake", small.scene(), "-o", out, "--error", "0.3"}).exit_code,
            0);
        files.push_back(read_text(out));
    }
    EXPECT_EQ(files[0], files[1]);
}

}  // namespace
}  // namespace opaline::tests
