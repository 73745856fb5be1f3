#include <gmock/gmock.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

// In few seconds; on a busy machine, in as many as a draft and the reference take.
Outcome sweep_in_time(const Arguments& arguments, const std::string& folder, int seconds) {
    Outcome sweep;
    bool has_time = false;
    for (; !has_time && seconds < 200; seconds *= 2) {
        sweep = run_opaline(join(arguments, {"-o", folder, "--seconds", std::to_string(seconds)}));
        has_time = sweep.exit_code != 2 &&
                   read_text(folder + "/sweep.json").find("\"reference\": {") != std::string::npos;
    }
    EXPECT_EQ(sweep.exit_code, 0) << sweep.err;
    return sweep;
}

// All bakes take minutes, nearly all for the lights they are checked under: a few will do.
TEST(Sweep, WritesTableJsonAndPageThatAgreeAndNamesWhatItLeftOut) {
    SmallScene small;
    const std::string out = small.path("new/folder");
    const Outcome sweep = sweep_in_time({"sweep", small.scene(), "--seed", "3"}, out, 2);
    EXPECT_EQ(list_folder(out), (Arguments{"report.html", "sweep.csv", "sweep.json"}));
    EXPECT_THAT(sweep.err, HasSubstr("left out"));
    const Json json = Json::parse(read_text(out + "/sweep.json"));
    EXPECT_EQ(json.at("seed"), 3);
    EXPECT_EQ(json.at("scene").at("name"), "scene.glb");
    EXPECT_EQ(json.at("scene").at("receivers"), 8);
    const Json& points = json.at("points");
    ASSERT_FALSE(points.empty());
    EXPECT_EQ(points.at(0).at("label"), "draft");
    const Json& finest = points.at(json.at("truth").get<std::size_t>());
    for (const Json& point : points) {
        EXPECT_GE(point.at("error").at("rms_relative"), finest.at("error").at("rms_relative"));
        double seconds = 0;
        for (const Json& group : point.at("seconds_by_group")) {
            seconds += group.get<double>();
        }
        EXPECT_NEAR(seconds, point.at("seconds").get<double>(), 1e-6) << point.at("label");
    }
    const std::string csv = read_text(out + "/sweep.csv");
    const std::size_t rungs = json.at("reference").at("rungs").size();
    EXPECT_GE(rungs, 2u);
    EXPECT_EQ(json.at("slopes").back().at("ladder"), "reference_samples");
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
              points.size() + rungs + 1);
    EXPECT_THAT(read_text(out + "/report.html"), HasSubstr("scene.glb"));
    ASSERT_FALSE(json.at("skipped").empty());
    for (const Json& skipped : json.at("skipped")) {
        EXPECT_FALSE(skipped.at("label").get<std::string>().empty());
        EXPECT_THAT(skipped.at("reason").get<std::string>(), HasSubstr(" left"));
    }
    // The size of a point is that of the file that a bake writes.
    const std::string file = small.path("draft.opal");
    run_well({"bake", small.scene(), "-o", file, "--quality", "draft", "--seed", "3", "--refine",
              "off"});
    EXPECT_EQ(points.at(0).at("bytes"), std::filesystem::file_size(file));
}

TEST(Sweep, WhatCannotBeWrittenIsFoundOutBeforeTheWork) {
    SmallScene small;
    write_file(small.path("taken"), std::string("mine"));
    expect_refused({"sweep", small.scene(), "-o", small.path("taken")}, 2,
                   "is a file, not a folder");
    EXPECT_EQ(read_text(small.path("taken")), "mine");
    expect_refused({"sweep", small.scene(), "-o", small.path("new"), "--light", "sun:north"}, 2,
                   "");
    EXPECT_FALSE(std::filesystem::exists(small.path("new")));
    EXPECT_EQ(run_opaline({"sweep", small.scene()}).exit_code, 2);
    EXPECT_EQ(
        run_opaline({"sweep", small.scene(), "-o", small.path("new"), "--seconds", "0"}).exit_code,
        2);
    EXPECT_EQ(run_opaline({"sweep", small.path("none.glb"), "-o", small.path("new")}).exit_code, 3);
    EXPECT_FALSE(std::filesystem::exists(small.path("new")));
}

// Debian's chromium, or another of its family.
std::string find_browser() {
    const Outcome found = run_any({"sh", "-c",
                                   "command -v chromium || command -v chromium-browser || "
                                   "command -v google-chrome"});
    return found.out.substr(0, found.out.find('\n'));
}

TEST(Sweep, PageOpensInABrowserWithoutAComplaint) {
    const std::string browser = find_browser();
    if (browser.empty()) {
        GTEST_SKIP() << "no browser (install chromium)";
    }
    const TemporaryFolder folder;
    write_file(folder / "sheet.glb", wavy_sheet(30).glb());
    sweep_in_time({"sweep", folder / "sheet.glb", "--threads", "2"}, folder / "s", 3);
    const Outcome page = run_any({"bash", OPALINE_SOURCE_DIR "/tests/cli/report_page.sh",
                                  folder / "s/report.html", browser, folder.path().string()});
    EXPECT_EQ(page.exit_code, 0) << page.out << page.err;
}

TEST(Sweep, InterruptedSweepLeavesNothing) {
    const TemporaryFolder folder;
    write_file(folder / "sheet.glb", wavy_sheet(100).glb());
    const Outcome sweep =
        start_opaline({"sweep", folder / "sheet.glb", "-o", folder / "s"}, [&](int process) {
            while (!std::filesystem::exists(folder / "s")) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
            // Its files have no names before it ends.
            std::this_thread::sleep_for(std::chrono::milliseconds(800));
            ::kill(process, SIGINT);
        });
    EXPECT_EQ(sweep.exit_code, 130) << sweep.err;
    EXPECT_EQ(list_folder(folder.path()), Arguments{"sheet.glb"});
}

}  // namespace
}  // namespace opaline::tests
