#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Bake, ManyMoreThreadsThanCoresPrintNothing) {
    SmallScene small;
    const auto threads = std::to_string(3 * std::thread::hardware_concurrency());
    const Outcome bake = start_opaline({"bake", small.scene(), "-o", small.path("a.opal"),
                                        "--quality", "draft", "--quiet", "--threads", threads});
    EXPECT_EQ(bake.exit_code, 0);
    EXPECT_EQ(bake.err, "") << "TBB warns of threads that it does not start";
}

TEST(Bake, ReportHasTheKeysOfTheContract) {
    SmallScene small;
    const Outcome bake = run_well({"bake", small.scene(), "-o", small.path("a.opal"), "--report",
                                   small.path("r.json"), "--refine", "off", "--quality", "draft",
                                   "--seed", "7", "--threads", "2"});
    EXPECT_EQ(bake.out, "");
    const Json report = Json::parse(read_text(small.path("r.json")));
    EXPECT_THAT(report.at("version").get<std::string>(), ::testing::MatchesRegex("[0-9.]+"));
    EXPECT_EQ(report.at("scene").at("sha256").get<std::string>().size(), 64u);
    EXPECT_EQ(report.at("seed"), 7);
    EXPECT_EQ(report.at("threads"), 2);
    EXPECT_EQ(report.at("knobs").at("cubemap"), 8);
    EXPECT_EQ(report.at("knobs").at("coefficients"), 64);
    ASSERT_FALSE(report.at("plan").empty());
    int lit_by_others = 0;
    for (const Json& entry : report.at("plan")) {
        EXPECT_FALSE(entry.at("subject").get<std::string>().empty());
        EXPECT_FALSE(entry.at("reason").get<std::string>().empty());
        EXPECT_EQ(entry.at("forced"), false);
        EXPECT_GT(entry.at("bound").get<double>(), 0);
        if (entry.at("effect") == "direct") {
            EXPECT_EQ(entry.at("decision"), "on");
            EXPECT_GT(entry.at("predicted_seconds").get<double>(), 0);
        } else if (entry.at("effect") == "interreflection") {
            lit_by_others += entry.at("decision") == "on" ? 1 : 0;
        } else {
            EXPECT_EQ(entry.at("effect"), "light.visibility");
        }
    }
    EXPECT_EQ(lit_by_others, 1) << "nothing rises above the upper square";
    ASSERT_FALSE(report.at("stages").empty());
    double seconds = 0, traced = 0;
    for (const Json& stage : report.at("stages")) {
        const auto name = stage.at("name").get<std::string>();
        const auto rays = stage.at("rays").get<double>();
        if (name.starts_with("rows of ") || name == "self-check") {
            EXPECT_GT(stage.at("predicted_seconds").get<double>(), 0) << name;
            traced += rays;
        } else if (name == "interreflection") {
            EXPECT_GT(rays, 0);
        } else {
            EXPECT_EQ(rays, 0) << name;
        }
        EXPECT_GT(stage.at("peak_rss_bytes").get<double>(), 1e6);
        seconds += stage.at("seconds").get<double>();
    }
    EXPECT_LE(seconds, report.at("seconds_total").get<double>() * 1.001);
    EXPECT_GT(traced, 1000) << "the upper square shades the lower one";
    const Json& error = report.at("error");
    EXPECT_GE(error.at("rms_relative").get<double>(), error.at("ci95").at(0).get<double>());
    EXPECT_LE(error.at("rms_relative").get<double>(), error.at("ci95").at(1).get<double>());
    EXPECT_LE(error.at("p95_relative").get<double>(), error.at("max_relative").get<double>());
    EXPECT_EQ(error.at("receivers_checked"), 8);
    EXPECT_GT(error.at("points_between_checked"), 0);
    for (const char* place : {"at_receivers", "between"}) {
        const Json& own = error.at(place);
        EXPECT_GT(own.at("rms_relative").get<double>(), 0) << place;
        EXPECT_LE(own.at("ci95").at(0).get<double>(), own.at("rms_relative").get<double>());
        EXPECT_GE(own.at("ci95").at(1).get<double>(), own.at("rms_relative").get<double>());
    }
    EXPECT_FALSE(error.at("reference").get<std::string>().empty());
    EXPECT_TRUE(error.at("by_effect").contains("direct"));
    const Json& output = report.at("output");
    EXPECT_EQ(output.at("bytes"), std::filesystem::file_size(small.path("a.opal")));
    EXPECT_EQ(output.at("receivers"), 8);
    EXPECT_EQ(output.at("terms"), 1);
    EXPECT_EQ(output.at("coefficients_per_term"), 64);
    EXPECT_TRUE(report.at("warnings").is_array());
}

TEST(Bake, TermsOfTheReportAreTheMostThatAnyPrimitiveHas) {
    SmallScene small;
    for (const char* material : {"Chalk", "Brick"}) {
        Json medium = {{"sigma_s", {1, 1, 1}}, {"sigma_a", {0.1, 0.1, 0.1}}};
        medium["phase"] = {{"type", "hg"}, {"g", 0.5}};
        write_file(small.path("media.json"),
                   Json{{"materials", {{material, std::move(medium)}}}}.dump());
        run_well({"bake", small.scene(), "-o", small.path("a.opal"), "--report",
                  small.path("r.json"), "--quality", "draft", "--media", small.path("media.json"),
                  "--phase-terms", "4", "--effects", "direct,single"});
        const Json report = Json::parse(read_text(small.path("r.json")));
        EXPECT_EQ(report.at("output").at("terms"), 4) << material;
    }
}

TEST(Bake, CheckModelComparesWithTheReferenceAndTellsReportFileAndUser) {
    SmallScene small;
    const std::string out = small.path("a.opal"), report = small.path("r.json");
    AssetBuilder asset = two_squares();
    asset.json["materials"][1]["doubleSided"] = true;
    write_file(small.path("two-sided.glb"), asset.glb());
    const Arguments plain = {"bake",      small.path("two-sided.glb"),
                             "-o",        out,
                             "--report",  report,
                             "--quality", "draft",
                             "--effects", "direct"};
    Arguments checked = plain;
    checked.push_back("--check-model");
    run_well(plain);
    EXPECT_FALSE(Json::parse(read_text(report)).contains("model_error"));
    const Outcome bake = run_well(checked);
    EXPECT_THAT(bake.err, HasSubstr("; model error "));
    Json error = Json::parse(read_text(report)).at("model_error");
    EXPECT_GE(error.at("rms_relative").get<double>(), error.at("ci95").at(0).get<double>());
    EXPECT_LE(error.at("rms_relative").get<double>(), error.at("ci95").at(1).get<double>());
    EXPECT_LT(std::abs(error.at("bias").get<double>()), 1);
    // The light that the lower square and the back of the upper one reflect onto each other.
    EXPECT_GT(error.at("missing").get<double>(), 0.02);
    EXPECT_LT(error.at("missing").get<double>(), 0.2);
    EXPECT_GT(error.at("receivers_checked"), 0);
    EXPECT_GT(error.at("samples"), 0);
    EXPECT_GT(error.at("seconds").get<double>(), 0);
    EXPECT_FALSE(error.at("reference").get<std::string>().empty());
    EXPECT_TRUE(error.at("left_out").empty()) << "nothing refracts";
    // The whole lies between its parts.
    double least = 1, most = 0;
    EXPECT_EQ(error.at("by_light").size(), 6u);
    for (const char* light : {"white", "sun:30,60", "studio", "sky:3,35"}) {
        EXPECT_TRUE(error.at("by_light").contains(light)) << light;
    }
    for (const Json& part : error.at("by_light")) {
        least = std::min(least, part.at("rms_relative").get<double>());
        most = std::max(most, part.at("rms_relative").get<double>());
    }
    EXPECT_LE(least, error.at("rms_relative").get<double>());
    EXPECT_GE(most, error.at("rms_relative").get<double>());
    EXPECT_THAT(run_opaline({"info", out}).out, HasSubstr("model error"));
    error.erase("seconds");
    const Json info = Json::parse(run_opaline({"info", out, "--json"}).out);
    EXPECT_EQ(info.at("provenance").at("model_error"), error);
}

TEST(Bake, TargetErrorIsReportedWithWhatThePilotTried) {
    SmallScene small;
    const std::string out = small.path("a.opal"), report = small.path("a.json");
    const Outcome bake =
        run_well({"bake", small.scene(), "-o", out, "--report", report, "--error", "0.2"});
    EXPECT_THAT(bake.err, HasSubstr("asked for 20 %, expected "));
    const Json json = Json::parse(read_text(report));
    const Json& accuracy = json.at("accuracy");
    EXPECT_EQ(accuracy.at("error_requested"), 0.2);
    EXPECT_LE(accuracy.at("error_predicted").get<double>(), 0.2);
    // Two squares of four vertices each: what the pilot found at vertices says little of the rest.
    const Json& error = json.at("error");
    const double at_receivers = error.at("at_receivers").at("rms_relative").get<double>();
    const double between = error.at("between").at("rms_relative").get<double>();
    EXPECT_LE(at_receivers, 0.2);
    EXPECT_EQ(accuracy.at("met").get<bool>(), between <= 0.2);
    ASSERT_FALSE(accuracy.at("trials").empty());
    EXPECT_EQ(accuracy.at("trials").at(0).at("knob"), "coefficients");
    const Json info = Json::parse(run_opaline({"info", out, "--json"}).out);
    EXPECT_EQ(info.at("provenance").at("error_requested"), 0.2);
}

TEST(Bake, TestLightsAreComputedOnceForAllBakes) {
    SmallScene small;
    const TemporaryFolder cache;
    using Times = std::map<std::filesystem::path, std::filesystem::file_time_type>;
    const auto lights = [&] {
        Times written;
        for (const auto& file : std::filesystem::recursive_directory_iterator(cache.path())) {
            if (file.is_regular_file() &&
                file.path().string().find("test-lights") != std::string::npos) {
                written[file.path()] = file.last_write_time();
            }
        }
        return written;
    };
    Times first;
    for (const int i : {0, 1}) {
        const Outcome bake = run_with_cache(
            cache.path(), {"bake", small.scene(), "-o",
                           small.path("a" + std::to_string(i) + ".opal"), "--quality", "draft"});
        ASSERT_EQ(bake.exit_code, 0) << bake.err;
        if (i == 0) first = lights();
    }
    EXPECT_FALSE(first.empty());
    EXPECT_EQ(lights(), first) << "they were computed again";
    EXPECT_EQ(read_text(small.path("a0.opal")), read_text(small.path("a1.opal")));
}

TEST(Bake, CompressionChangesTheSizeOfTheFileAndNoLight) {
    SmallScene small;
    std::map<std::string, std::uintmax_t> size;
    std::string light;
    for (const std::string compression : {"none", "fast", "best"}) {
        const std::string out = small.path(compression + ".opal");
        run_well(
            {"bake", small.scene(), "-o", out, "--quality", "draft", "--compression", compression});
        size[compression] = std::filesystem::file_size(out);
        run_well({"verify", out});
        const std::string table = small.path("light.csv");
        run_well({"relight", out, "--light", "studio", "-o", table});
        if (light.empty()) light = read_text(table);
        EXPECT_EQ(read_text(table), light);
    }
    EXPECT_LT(size["fast"], size["none"]);
    EXPECT_LE(size["best"], size["fast"]);
}

TEST(Bake, SameBytesWhereverTheSceneLies) {
    SmallScene here, there;
    EXPECT_EQ(read_text(here.baked()), read_text(there.baked()));
}

TEST(Bake, DepfileTellsMakeWhenToBakeAgain) {
    const TemporaryFolder folder;
    const AssetBuilder asset = two_squares();
    write_file(folder / "a scene.gltf", asset.text_with_external_buffer());
    write_file(folder / "buffer.bin", asset.bin);
    std::ofstream(folder / "Makefile")
        << "out.opal:\n\t" OPALINE_PROGRAM
           " bake 'a scene.gltf' -o out.opal --depfile out.d --quality draft\n-include out.d\n";
    const Arguments make = {"make", "-C", folder.path().string()};
    const Arguments is_current = {"make", "-q", "-C", folder.path().string()};
    ASSERT_EQ(run_any(make).exit_code, 0);
    EXPECT_EQ(run_any(is_current).exit_code, 0);
    for (const char* input : {"a scene.gltf", "buffer.bin"}) {
        const auto after =
            std::filesystem::last_write_time(folder / "out.opal") + std::chrono::seconds(2);
        std::filesystem::last_write_time(folder / input, after);
        EXPECT_EQ(run_any(is_current).exit_code, 1) << input << read_text(folder / "out.d");
        std::filesystem::last_write_time(folder / input, after - std::chrono::hours(1));
    }
}

TEST(Bake, ProgressIsJsonLinesOnRequestAndSilentOffATerminal) {
    SmallScene small;
    const std::string out = small.path("a.opal");
    const Outcome json = run_well({"bake", small.scene(), "-o", out, "--progress", "json"});
    std::istringstream lines(json.err);
    std::string line;
    std::map<std::string, std::vector<std::string>> events;  // by stage
    while (std::getline(lines, line)) {
        if (line.empty() || line[0] != '{') continue;
        const Json step = Json::parse(line);
        EXPECT_LE(step.at("done").get<double>(), step.at("total").get<double>());
        EXPECT_GE(step.at("seconds").get<double>(), 0);
        EXPECT_TRUE(step.at("eta_seconds").is_null() || step.at("eta_seconds").get<double>() >= 0);
        events[step.at("stage")].push_back(step.at("event"));
    }
    EXPECT_GT(events.size(), 1u);
    EXPECT_EQ(events["bake"], (std::vector<std::string>{"begin", "end"}));
    for (const auto& [stage, seen] : events) {
        EXPECT_EQ(seen.front(), "begin") << stage;
        EXPECT_EQ(seen.back(), "end") << stage;
        EXPECT_LE(seen.size(), 22u) << stage;
    }
    const Outcome silent = run_opaline({"bake", small.scene(), "-o", out, "--refine", "off"});
    EXPECT_THAT(silent.err, StartsWith(out + ": 8 receivers, "));
    EXPECT_EQ(std::count(silent.err.begin(), silent.err.end(), '\n'), 1);
}

TEST(Bake, InterruptedOrKilledBakeLeavesNothing) {
    const TemporaryFolder folder;
    write_file(folder / "sheet.glb", wavy_sheet(200).glb());
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
        const bool is_killed = signal == SIGKILL;
        if (is_killed && !has_unnamed_files()) {
            GTEST_SKIP() << "the file system has no O_TMPFILE";
        }
        const Outcome bake =
            start_opaline({"bake", folder / "sheet.glb", "-o", folder / "out.opal", "--report",
                           folder / "r.json", "--depfile", folder / "d", "--quality", "reference"},
                          [&](int process) {
                              // Its files have no names before it ends: some time after its start.
                              std::this_thread::sleep_for(std::chrono::milliseconds(1500));
                              ::kill(process, signal);
                          });
        EXPECT_EQ(bake.exit_code, is_killed ? 128 + SIGKILL : 130) << signal << bake.err;
        EXPECT_THAT(bake.err, HasSubstr(is_killed ? "" : "interrupted")) << signal;
        EXPECT_EQ(list_folder(folder.path()), Arguments{"sheet.glb"}) << signal;
    }
}

TEST(Bake, MetresPerUnitScalesTheGeometryAndNothingElse) {
    const SmallScene small;
    for (const std::string unit : {"1", "0.001"}) {
        // Random rays to other surfaces are keyed by places.
        const std::string file = small.path(unit + ".opal");
        run_well({"bake", small.scene(), "-o", file, "--quality", "draft", "--effects", "direct",
                  "--metres-per-unit", unit});
        run_well({"relight", file, "--light", "studio", "-o", file + ".csv"});
    }
    EXPECT_EQ(read_text(small.path("0.001.opal.csv")), read_text(small.path("1.opal.csv")));
}

TEST(Plan, NamesEffectSubjectAndReasonAsTableAndAsJson) {
    SmallScene small;
    const Outcome table = run_well({"plan", small.scene()});
    EXPECT_THAT(table.out, HasSubstr("direct"));
    EXPECT_THAT(table.out, HasSubstr("Brick"));
    const Outcome json = run_well({"plan", small.scene(), "--json"});
    const Json plan = Json::parse(json.out).at("plan");
    ASSERT_FALSE(plan.empty());
    for (const Json& entry : plan) {
        for (const char* key :
             {"effect", "subject", "decision", "reason", "bound", "predicted_seconds",
              "predicted_bytes", "saved_seconds", "saved_bytes"}) {
            EXPECT_TRUE(entry.contains(key)) << key;
        }
    }
}

// Ink sends back nothing that scattered, unless that is forced.
TEST(Plan, EffectsAllTurnsOnWhatTheSceneDoesNotCallForAndSaysSo) {
    SmallScene small;
    std::ofstream(small.path("ink.json")) << R"({"materials": {"*": {"sigma_s": [1e-3, 1e-3, 1e-3],
        "sigma_a": [1e3, 1e3, 1e3], "unit": "1/m", "eta": 1.3}}})";
    const auto forced = [&](const char* effects, const char* decision) {
        const Outcome json = run_well({"plan", small.scene(), "--media", small.path("ink.json"),
                                       "--json", "--effects", effects});
        int count = 0, decided = 0;
        const Json plan = Json::parse(json.out);
        for (const Json& entry : plan.at("plan")) {
            count += entry.at("forced") == true ? 1 : 0;
            decided += entry.at("decision") == decision ? 1 : 0;
        }
        EXPECT_GT(decided, 0) << effects;
        return count;
    };
    EXPECT_EQ(forced("auto", "off"), 0);
    EXPECT_GE(forced("all", "on"), 2) << "multiple and single at least";
}

TEST(Example, EveryListedSceneBakes) {
    const TemporaryFolder folder;
    const Outcome list = run_well({"example", "--list"});
    for (const std::string name : {"statue", "knot", "studio", "white", "sun:", "sky:"}) {
        EXPECT_THAT(list.out, HasSubstr(name));
    }
    // The statue takes a while; its bake is the quick start's.
    const Outcome knot = run_well({"example", "knot", "-o", folder.path().string()});
    run_well({"plan", folder / "knot.gltf"});
}

TEST(Example, LightSavedAsExrLightsAsTheBuiltInOneDoes) {
    SmallScene small;
    // A sun goes to the texels around it, a map's pixels to the ones that they cover: on a coarse
    // cube map its direction differs by up to half a texel. Soft lights are the same.
    for (const auto& [light, tolerance] : {std::pair{"studio", "1e-3"},
                                           {"white", "1e-6"},
                                           {"sun:40,30", "0.25"},
                                           {"sky:3,35", "0.25"}}) {
        const Outcome example = run_well({"example", light, "-o", small.folder().string()});
        const std::string file = example.out.substr(0, example.out.find('\n'));
        EXPECT_THAT(file, ::testing::EndsWith(".exr"));
        const std::string a = small.path("a.csv"), b = small.path("b.csv");
        run_well({"relight", small.baked(), "--light", light, "-o", a});
        run_well({"relight", small.baked(), "--light", file, "-o", b});
        run_well({"compare", a, b, "--max-rel", tolerance});
    }
}

}  // namespace
}  // namespace opaline::tests
