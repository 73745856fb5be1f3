#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "bake/calibration/rates_cache.h"
#include "tests/cli/small_scene.h"
#include "tests/support/rates.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The program with a cache folder of the test's choice.
Outcome run_with_cache(const std::string& cache, const Arguments& arguments) {
    Arguments command{"env", "XDG_CACHE_HOME=" + cache, OPALINE_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_any(command);
}

void keep(const std::string& cache, const bake::Rates& rates) {
    ASSERT_TRUE(
        bake::write_rates(cache + "/opaline/calibration.json", bake::this_machine(), rates));
}

TEST(Prediction, MachineIsMeasuredOnceAndThatIsSaid) {
    SmallScene small;
    const std::string cache = small.path("cache");
    const Outcome first = run_with_cache(cache, {"plan", small.scene()});
    EXPECT_EQ(first.exit_code, 0) << first.err;
    EXPECT_THAT(first.err, HasSubstr("measuring this machine once"));
    EXPECT_EQ(list_folder(cache + "/opaline"), std::vector<std::string>{"calibration.json"});
    const Outcome second = run_with_cache(cache, {"plan", small.scene()});
    EXPECT_EQ(second.exit_code, 0) << second.err;
    EXPECT_EQ(second.err, "");
    EXPECT_EQ(second.out, first.out);
    // What another machine left there is measured anew, and replaced.
    bake::MachineKey other = bake::this_machine();
    other.threads += 1;
    ASSERT_TRUE(bake::write_rates(cache + "/opaline/calibration.json", other, make_rates()));
    EXPECT_THAT(run_with_cache(cache, {"plan", small.scene()}).err, HasSubstr("measuring"));
    EXPECT_EQ(run_with_cache(cache, {"plan", small.scene()}).err, "");
}

TEST(Prediction, CacheThatCannotBeWrittenIsNoErrorButNoted) {
    SmallScene small;
    const std::string report = small.path("r.json");
    const Outcome bake = run_with_cache(small.scene() + "/no-folder",
                                        {"bake", small.scene(), "-o", small.path("a.opal"),
                                         "--quality", "draft", "--report", report});
    EXPECT_EQ(bake.exit_code, 0) << bake.err;
    EXPECT_THAT(bake.err, Not(HasSubstr("error: ")));
    const Json json = Json::parse(read_text(report));
    EXPECT_THAT(json.at("calibration").get<std::string>(), HasSubstr("cannot be kept"));
    EXPECT_GT(json.at("predicted_seconds_total").get<double>(), 0);
}

TEST(Prediction, PlanTellsStagesAndTotalInJsonAndAtTheFootOfItsTable) {
    SmallScene small;
    keep(small.path("cache"), make_rates());
    const Outcome plan =
        run_with_cache(small.path("cache"), {"plan", small.scene(), "--json", "--threads", "2"});
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
    const Outcome table =
        run_with_cache(small.path("cache"), {"plan", small.scene(), "--threads", "1"});
    EXPECT_THAT(table.out, HasSubstr("\nthe rest "));
    EXPECT_THAT(table.out,
                ::testing::ContainsRegex("\npredicted: .* on 1 thread, .*, 8 receivers"));
}

TEST(Prediction, ReportSetsPredictedBesideMeasuredStageByStage) {
    SmallScene small;
    keep(small.path("cache"), make_rates());
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
        bake::Rates rates = make_rates();
        bake::visit_rates(rates, [factor](const char*, double& rate) { rate *= factor; });
        const std::string cache = small.path("cache" + std::to_string(files.size()));
        keep(cache, rates);
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
