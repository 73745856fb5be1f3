// `opaline view` on a display without a monitor. Its pictures are compared with those of `opaline
// render`, which knows nothing of windows.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "formats/image/png.h"
#include "formats/opal/write_opal.h"
#include "tests/cli/small_scene.h"
#include "tests/formats/opal/emitter_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kNoDisplay = 77;  // with_display.sh

// In the scene's folder.
Outcome view_with(const SmallScene& small, const std::string& script, Arguments options,
                  const std::function<void(int)>& when_started = {}) {
    std::ofstream(small.path("script.txt")) << script;
    Arguments command{
        "env", "-C", small.folder().string(), std::string("XDG_CACHE_HOME=") + OPALINE_TEST_CACHE,
        // Drivers keep memory to the end: leaks of ours are found by other tests.
        "ASAN_OPTIONS=detect_leaks=0", "bash", OPALINE_WITH_DISPLAY, OPALINE_PROGRAM, "view"};
    command.insert(command.end(), options.begin(), options.end());
    command.insert(command.end(), {"--script", "script.txt"});
    return run_any(command, when_started);
}

std::vector<std::string> printed_lines(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

formats::Image8 read_picture(const std::string& path) {
    auto image = formats::read_png(path);
    EXPECT_TRUE(image) << path;
    return image ? *image : formats::Image8{};
}

// A printed line, run as it is but for the name of its output.
formats::Image8 render_line_again(const SmallScene& small, std::string line) {
    const std::string output = small.path("again.png");
    const std::size_t end = line.rfind(" -o ");
    EXPECT_EQ(line.rfind("opaline render ", 0), 0u) << line;
    line = std::string(OPALINE_PROGRAM) + line.substr(7, end - 7) + " -o " + output;
    const Outcome outcome = run_any({"env", "-C", small.folder().string(), "bash", "-c", line});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err << line;
    return read_picture(output);
}

struct Columns {
    std::uint32_t first = 0, end = 0;
};

// The largest difference of two pictures' bytes in some columns.
int largest_difference(const formats::Image8& a, const formats::Image8& b, Columns columns) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    int largest = 0;
    for (std::uint32_t y = 0; y < std::min(a.height, b.height); ++y) {
        for (std::size_t i = 4 * (std::size_t{y} * a.width + columns.first);
             i < 4 * (std::size_t{y} * a.width + columns.end); ++i) {
            largest = std::max(largest, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
        }
    }
    return largest;
}

Columns all_columns(const formats::Image8& image) {
    return {0, image.width};
}

TEST(View, ScreenshotsAreWhatTheirPrintedLinesRender) {
    SmallScene small;
    small.baked();
    const Outcome outcome =
        view_with(small,
                  "screenshot 0.png\n"
                  "orbit 30 12\nrotate-light 75\nexposure 0.7\n"
                  "screenshot 1.png\n"
                  "turn 0 0 0.3 0.4\nzoom 1.5\npan 0.1 -0.05\ntone-map none\n"
                  "light white\ncoefficients 12\nscreenshot 2.png\n"
                  "coefficients all\ntoggle diffuse\nframe\nscreenshot 3.png\n"
                  "terms all\nscreenshot 4.png\nphotograph 5.png\nquit\n",
                  {"scene.opal", "--light", "sun:30,40", "--size", "440x280", "--fov", "45"});
    if (outcome.exit_code == kNoDisplay) GTEST_SKIP() << "no Xvfb";
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto lines = printed_lines(outcome.out);
    ASSERT_EQ(lines.size(), 5u) << outcome.out;
    EXPECT_THAT(lines[2], HasSubstr("--coefficients 12 --exposure 0.7 --tone-map none"));
    std::vector<formats::Image8> shots;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        shots.push_back(read_picture(small.path(std::to_string(i) + ".png")));
        EXPECT_EQ(shots[i].width, 440u);
        EXPECT_LE(
            largest_difference(shots[i], render_line_again(small, lines[i]), all_columns(shots[i])),
            1)
            << lines[i];
        if (i > 0) {
            EXPECT_GT(largest_difference(shots[i], shots[i - 1], all_columns(shots[i])), 20) << i;
        }
    }
    // The controls stand on the left.
    const formats::Image8 window = read_picture(small.path("5.png"));
    EXPECT_GT(largest_difference(window, shots[4], {0, 300}), 100);
    EXPECT_EQ(largest_difference(window, shots[4], {400, 440}), 0);
    // Nothing is remembered.
    EXPECT_THAT(list_folder(small.folder()), Not(::testing::Contains(HasSubstr("ini"))));
}

TEST(View, TwoFilesShareTheWindowAndEmittersAreDimmed) {
    SmallScene small;
    small.baked();
    auto file = formats::AtomicFile::create(small.path("lamps.opal"));
    ASSERT_TRUE(file && formats::write_opal(make_emitter_asset().view(), std::move(*file)));
    const Outcome outcome = view_with(small,
                                      "beside scene.opal\nsplit 0.5\nemitter Lamp=0.25,0,1\n"
                                      "screenshot a.png\ndifference 1\nscreenshot b.png\n"
                                      "split 0.95\nphotograph d.png\nscreenshot e.png\n"
                                      "beside none\nscreenshot c.png\nquit\n",
                                      {"lamps.opal", "--light", "white", "--size", "320x240"});
    if (outcome.exit_code == kNoDisplay) GTEST_SKIP() << "no Xvfb";
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto lines = printed_lines(outcome.out);
    ASSERT_EQ(lines.size(), 7u) << outcome.out;
    EXPECT_THAT(lines[0], HasSubstr("--emitter Lamp=0.25,0,1"));
    const formats::Image8 split = read_picture(small.path("a.png"));
    const formats::Image8 left = render_line_again(small, lines[0]);
    EXPECT_LE(largest_difference(split, left, {0, 160}), 1);
    // The scene has no such emitter, which `render` would refuse to dim.
    const formats::Image8 right = render_line_again(small, lines[1]);
    EXPECT_LE(largest_difference(split, right, {160, 320}), 1);
    EXPECT_GT(largest_difference(split, left, {160, 320}), 20);
    EXPECT_GT(largest_difference(read_picture(small.path("b.png")), split, {160, 320}), 20);
    EXPECT_LE(largest_difference(read_picture(small.path("c.png")), left, {0, 320}), 1);
    // With the controls a line shows where the split is.
    const formats::Image8 window = read_picture(small.path("d.png"));
    const formats::Image8 alone = read_picture(small.path("e.png"));
    EXPECT_GT(largest_difference(window, alone, {303, 306}), 50);
    EXPECT_EQ(largest_difference(window, alone, {310, 320}), 0);
}

TEST(View, ErrorsByReceiverAreThePictureThatTheirLineRenders) {
    SmallScene small;
    ASSERT_EQ(run_opaline({"bake", small.scene(), "-o", small.path("scene.opal"), "--coefficients",
                           "24", "--receiver-errors"})
                  .exit_code,
              0);
    const Outcome outcome = view_with(small,
                                      "orbit 0 40\nscreenshot 0.png\n"
                                      "receiver-errors 0.1\nexposure 1\nscreenshot 1.png\n"
                                      "receiver-errors 0.4\nscreenshot 2.png\n"
                                      "photograph 3.png\n"
                                      "receiver-errors 0\nexposure 0\nscreenshot 4.png\nquit\n",
                                      {"scene.opal", "--light", "studio", "--size", "480x300"});
    if (outcome.exit_code == kNoDisplay) GTEST_SKIP() << "no Xvfb";
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto lines = printed_lines(outcome.out);
    ASSERT_EQ(lines.size(), 4u) << outcome.out;
    const auto picture = [&](int i) {
        return read_picture(small.path(std::to_string(i) + ".png"));
    };
    EXPECT_THAT(lines[1], HasSubstr("--receiver-errors 0.1 -o"));
    for (const int i : {1, 2}) {
        EXPECT_LE(largest_difference(picture(i), render_line_again(small, lines[i]), {0, 480}), 1);
        EXPECT_GT(largest_difference(picture(i), picture(i - 1), {0, 480}), 20);
    }
    EXPECT_EQ(largest_difference(picture(4), picture(0), {0, 480}), 0);
    // The scale stands among the controls.
    EXPECT_GT(largest_difference(picture(3), picture(2), {0, 280}), 100);
}

TEST(View, ReadsAFileAgainThatChanges) {
    SmallScene small;
    small.baked();
    std::filesystem::copy(small.path("scene.opal"), small.path("shown.opal"));
    ASSERT_EQ(run_opaline({"bake", small.scene(), "-o", small.path("other.opal"), "--coefficients",
                           "10", "--seed", "3"})
                  .exit_code,
              0);
    const auto replace = [&](int) {
        using namespace std::chrono_literals;
        for (int i = 0; i < 3000 && !std::filesystem::exists(small.path("a.png")); ++i) {
            std::this_thread::sleep_for(20ms);
        }
        std::filesystem::rename(small.path("other.opal"), small.path("shown.opal"));
    };
    const Outcome outcome =
        view_with(small, "screenshot a.png\nwait-reload\nscreenshot b.png\nquit\n",
                  {"shown.opal", "--light", "sun:30,40", "--size", "320x240"}, replace);
    if (outcome.exit_code == kNoDisplay) GTEST_SKIP() << "no Xvfb";
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const formats::Image8 after = read_picture(small.path("b.png"));
    EXPECT_LE(largest_difference(after, render_line_again(small, printed_lines(outcome.out)[1]),
                                 all_columns(after)),
              1);
    EXPECT_GT(largest_difference(after, read_picture(small.path("a.png")), all_columns(after)), 2);
}

TEST(View, WithoutADisplaySaysSoAndExitsWithFour) {
    SmallScene small;
    const Outcome outcome =
        run_any({"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", "ASAN_OPTIONS=detect_leaks=0",
                 OPALINE_PROGRAM, "view", small.baked()});
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_THAT(outcome.err, HasSubstr("no display can be opened"));
    EXPECT_THAT(outcome.err, HasSubstr("opaline render"));
}

TEST(View, FaultsOfAScriptNameItsLines) {
    SmallScene small;
    const std::string file = small.baked();
    std::ofstream(small.path("bad.txt")) << "orbit 1 2\nfly 3\nexposure x\n";
    const Outcome bad = run_opaline({"view", file, "--script", small.path("bad.txt")});
    EXPECT_EQ(bad.exit_code, 3);
    EXPECT_THAT(bad.err, HasSubstr("bad.txt: line 2: 'fly' is no command"));
    EXPECT_THAT(bad.err, HasSubstr("bad.txt: line 3: expected exposure EV|auto"));
    const Outcome outcome =
        view_with(small, "wait-frames 2\nload none.opal\nscreenshot a.png\nquit\n",
                  {file, "--size", "160x120"});
    if (outcome.exit_code == kNoDisplay) GTEST_SKIP() << "no Xvfb";
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("script.txt line 2"));
    EXPECT_THAT(outcome.err, HasSubstr("none.opal"));
}

}  // namespace
}  // namespace opaline::tests
