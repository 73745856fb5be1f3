// Requests that contradict the scene or each other: the user learns what was decided instead.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bake/pipeline/calibration/rates_cache.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kFog = R"("sigma_s": [9, 9, 9], "sigma_a": [9, 9, 9], "unit": "1/m")";

class Requests : public ::testing::Test {
  protected:
    // Of the two squares, of this medium; opaque if it is empty. Plans say what bakes do.
    Outcome plan(const std::string& medium, const Arguments& options) {
        return run({"plan", small_.scene()}, medium, options);
    }
    Outcome bake(const std::string& medium, const Arguments& options) {
        return run({"bake", small_.scene(), "-o", small_.path("a.opal")}, medium, options);
    }

  private:
    Outcome run(Arguments line, const std::string& medium, const Arguments& options) {
        if (!medium.empty()) {
            std::ofstream(small_.path("media.json"))
                << "{\"materials\": {\"*\": {" << medium << "}}}";
            line.insert(line.end(), {"--media", small_.path("media.json")});
        }
        line.insert(line.end(), options.begin(), options.end());
        Outcome outcome = run_opaline(line);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return outcome;
    }

    SmallScene small_;
};

TEST_F(Requests, FewerPhaseTermsThanTheErrorNeedsAreTakenWithAWarning) {
    const std::string forward = std::string(kFog) + R"(, "phase": {"type": "hg", "g": 0.7})";
    EXPECT_THAT(
        bake(forward, {"--quality", "draft", "--effects", "single", "--phase-terms", "1"}).err,
        HasSubstr("material 'Chalk': --phase-terms 1 was taken as given; the quality "
                  "needs "));
    const auto plan_dipole = [&](const char* terms) {
        return plan(forward, {"--phase-terms", terms, "--multiple-model", "dipole"}).err;
    };
    EXPECT_THAT(plan_dipole("25"), Not(HasSubstr("--phase-terms")));
    EXPECT_THAT(plan_dipole("1"), HasSubstr("--phase-terms 1 was taken as given"));
    EXPECT_THAT(plan(forward, {"--phase-terms", "25"}).err,
                HasSubstr("not used here: --phase-terms"))
        << "random walks carry light scattered once";
}

TEST_F(Requests, TermsOfAnIsotropicPhaseFunctionAreOne) {
    EXPECT_THAT(plan(kFog, {"--phase-terms", "16"}).err, HasSubstr("not used here: --phase-terms"));
    EXPECT_THAT(plan(kFog, {"--phase-terms", "1"}).err, Not(HasSubstr("--phase-terms")));
}

TEST_F(Requests, OptionsOfMediaSayThatAnOpaqueSceneHasNone) {
    const Arguments options = {"--samples",       "500", "--epsilon",     "0.1",
                               "--depth-samples", "3",   "--phase-terms", "4",
                               "--separate-terms"};
    const Outcome opaque = bake("", options);
    EXPECT_THAT(opaque.err, ContainsRegex("not used here: --.*, --separate-terms"));
    for (const char* option : {"--samples", "--epsilon", "--depth-samples", "--phase-terms"}) {
        EXPECT_THAT(opaque.err, HasSubstr(std::string(option) + ", "));
    }
    EXPECT_THAT(plan("", {}).err, Not(HasSubstr("not used here")));
    EXPECT_THAT(plan(std::string(kFog) + R"(, "phase": {"type": "hg", "g": 0.7})", options).err,
                Not(HasSubstr("not used here")));
}

TEST_F(Requests, NamedEffectsThatAreLeftOutAreExplained) {
    const std::string matched = std::string(kFog) + R"(, "eta": 1)";
    EXPECT_THAT(plan(matched, {"--effects", "single,specular"}).err,
                AllOf(HasSubstr("--effects: 'specular' was left out all the same: the index of "
                                "refraction is that of the air"),
                      Not(HasSubstr("'single' was"))));
    EXPECT_THAT(plan(kFog, {"--effects", "direct,specular"}).err,
                HasSubstr("'specular' was left out all the same: the medium is shown as a "
                          "diffuse surface"));
    EXPECT_THAT(plan("", {"--effects", "direct,single"}).err,
                HasSubstr("--effects: 'single' concerns nothing in the scene"));
}

TEST_F(Requests, ErrorsThatFixedKnobsKeepOutOfReachNameTheKnobs) {
    const Outcome outcome = bake("", {"--error", "0.01", "--coefficients", "7"});
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("out of reach"), HasSubstr("leave --coefficients out")));
}

TEST(Request, OfAnEffectThatConcernsNothingIsRefused) {
    SmallScene small;
    for (const char* command : {"bake", "plan"}) {
        Arguments line = {command, small.scene(), "--effects", "single"};
        if (command == std::string("bake")) {
            line.insert(line.end(), {"-o", small.path("a.opal")});
        }
        expect_refused(line, 2, "'single' concerns nothing in the scene");
    }
    EXPECT_THAT(run_opaline({"plan", small.scene(), "--effects", "direct,auto"}).err,
                HasSubstr("'auto' stands by itself"));
}

TEST_F(Requests, PlansWarnOfOpenMediaAsBakesDo) {
    const auto warns = HasSubstr("material 'Chalk': the surface of the medium is open at ");
    EXPECT_THAT(plan(kFog, {}).err, warns);
    EXPECT_THAT(bake(kFog, {"--quality", "draft"}).err, warns);
    EXPECT_THAT(plan("", {}).err, Not(HasSubstr("open at")));
}

// A tetrahedron with a triangle of two sides within.
TEST(Request, PlansBakesAndPathTracersLeaveOutFlapsAndSaySo) {
    SmallScene small;
    AssetBuilder asset;
    const auto position = asset.add<float>(
        {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.1f, 0.1f, 0.1f, 0.2f, 0.1f, 0.1f, 0.1f, 0.2f, 0.1f},
        "VEC3");
    const auto index =
        asset.add<std::uint16_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 4, 5, 6, 4, 6, 5}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    const std::string scene = small.path("tetrahedron.glb"), media = small.path("media.json");
    write_file(scene, asset.glb());
    std::ofstream(media) << "{\"materials\": {\"*\": {" << kFog << "}}}";
    for (Arguments line : {Arguments{"plan", scene},
                           {"bake", scene, "-o", small.path("t.opal")},
                           {"reference", scene, "--light", "white", "--receivers", "9", "--spp",
                            "4", "-o", small.path("t.csv")}}) {
        line.insert(line.end(), {"--media", media});
        const Outcome outcome = run_well(line);
        EXPECT_THAT(outcome.err, AllOf(HasSubstr("bound nothing and were left out: 1"),
                                       Not(HasSubstr("is open")), Not(HasSubstr("face into"))))
            << line.front();
    }
    // Flat faces have twelve vertices, of which nine were asked for; those of the flap are none.
    std::ifstream table(small.path("t.csv"));
    std::string row;
    int rows = 0;
    while (std::getline(table, row)) {
        ++rows;
    }
    EXPECT_EQ(rows, 1 + 9);
}

TEST_F(Requests, PlansForAnErrorStartFromTheKnobsOfItsPilot) {
    EXPECT_THAT(plan("", {"--error", "0.02"}).out,
                HasSubstr("for the pilot of --error 0.02 to begin with"));
    // What is left out is a small share of the error asked for.
    const std::string weak = R"("sigma_s": [0.002, 0.002, 0.002], "sigma_a": [1, 1, 1])";
    EXPECT_THAT(plan(weak, {}).out, ContainsRegex("single +material 'Chalk' +off"));
    EXPECT_THAT(plan(weak, {"--error", "0.005"}).out,
                ContainsRegex("single +material 'Chalk' +on"));
}

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
