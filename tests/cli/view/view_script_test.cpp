#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bake/cli/view/file_watch.h"
#include "bake/cli/view/view_script.h"
#include "bake/cli/view/view_state.h"
#include "tests/support/temporary_folder.h"

namespace opaline::cli {
namespace {

using ::testing::HasSubstr;

// The state after all changes of a script.
ViewState carry_out(const std::string& text) {
    ViewState state;
    state.viewpoint = Viewpoint{{0, 0, 4}, {0, 0, 0}};
    const auto steps = parse_script(text, "s.txt");
    EXPECT_TRUE(steps) << steps.error().diagnostics.front().fault;
    for (const ScriptStep& step : *steps) {
        if (const auto* change = std::get_if<StateChange>(&step.what)) (*change)(state);
        if (const auto* emitter = std::get_if<EmitterChange>(&step.what)) {
            set_emitter(state, emitter->name, emitter->color);
        }
    }
    return state;
}

TEST(ViewScript, CommandsChangeWhatTheySay) {
    const ViewState state = carry_out(
        "light sky:3,35  # a clear day\n\n"
        "rotate-light 370\n"
        "exposure -1.5\r\n"
        "tone-map none\n"
        "toggle specular\n"
        "coefficients 32\n"
        "emitter \"Desk lamp=1,0.5,0\"\n"
        "time 60\n"
        "beside b.opal\n"
        "split 0.25\n"
        "difference 8\n"
        "receiver-errors 0.05\n"
        "toggle panels\n"
        "orbit 90 0\n"
        "zoom 2");
    EXPECT_EQ(state.light, "sky:3,35");
    EXPECT_EQ(state.rotate_light, 10);
    EXPECT_EQ(state.exposure, -1.5f);
    EXPECT_EQ(state.tone_map, runtime::ToneMap::none);
    EXPECT_EQ(state.terms, formats::TermSet::baked & ~formats::TermSet::specular);
    EXPECT_EQ(state.coefficients, 32u);
    EXPECT_EQ(emitter_color(state, "Desk lamp"), (formats::Rgb{1, 0.5f, 0}));
    EXPECT_EQ(state.time, 60);
    EXPECT_EQ(state.other, "b.opal");
    EXPECT_EQ(state.split, 0.25f);
    EXPECT_EQ(state.difference_gain, 8);
    EXPECT_EQ(state.error_white, 0.05f);
    EXPECT_FALSE(state.panels);
    EXPECT_LT(length(state.viewpoint->eye - formats::Vec3{2, 0, 0}), 1e-5f);
}

TEST(ViewScript, MovesOfTheCameraAreThoseOfTheMouse) {
    const Viewpoint begin{{0, 0, 4}, {0, 0, 0}};
    EXPECT_EQ(carry_out("turn 0 0 0.3 0.2").viewpoint, turn_ball(begin, {0, 0}, {0.3, 0.2}));
    EXPECT_EQ(carry_out("turn 0 0 0.3 0.2\nlevel").viewpoint->up, (formats::Vec3{0, 1, 0}));
    EXPECT_EQ(carry_out("pan 0.1 0.2").viewpoint, pan(begin, 32, 0.1, 0.2));
    EXPECT_EQ(carry_out("frame").viewpoint, std::nullopt);
}

TEST(ViewScript, AnotherFileIsShownAsItWasBaked) {
    const ViewState state = carry_out("coefficients 9\nemitter A=0\nterms diffuse\nload b.opal");
    EXPECT_EQ(state.file, "b.opal");
    EXPECT_EQ(state.viewpoint, std::nullopt);
    EXPECT_EQ(state.coefficients, std::nullopt);
    EXPECT_TRUE(state.emitters.empty());
    EXPECT_EQ(state.terms, formats::TermSet::baked);
}

TEST(ViewScript, EveryFaultIsNamedByItsLine) {
    const auto steps = parse_script(
        "orbit 1 2\n"
        "exposre 1\n"
        "exposure bright\n"
        "screenshot a.jpg\n"
        "load \"a.opal\n"
        "coefficients 5\n"
        "drop a.txt\n"
        "quit now\n",
        "s.txt");
    ASSERT_FALSE(steps);
    const auto& faults = steps.error().diagnostics;
    ASSERT_EQ(faults.size(), 7u);
    EXPECT_EQ(faults[0].file, "s.txt");
    EXPECT_EQ(faults[0].where, "line 2");
    EXPECT_THAT(faults[0].fault, HasSubstr("'exposre' is no command"));
    EXPECT_EQ(faults[1].where, "line 3");
    EXPECT_THAT(faults[1].fault, HasSubstr("expected exposure EV|auto"));
    EXPECT_EQ(faults[6].where, "line 8");
}

TEST(DropFile, EndingAndPlaceSayWhatItIsFor) {
    ViewState state;
    state.file = "a.opal";
    EXPECT_TRUE(drop_file(state, "sky.hdr", 0.1));
    EXPECT_EQ(state.light, "sky.hdr");
    state.other = "b.opal";
    EXPECT_TRUE(drop_file(state, "c.opal", 0.9));
    EXPECT_EQ(state.other, "c.opal");
    EXPECT_TRUE(drop_file(state, "d.opal", 0.1));
    EXPECT_EQ(state.file, "d.opal");
    EXPECT_FALSE(drop_file(state, "e.png", 0.1));
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

TEST(FileWatch, SaysOnceThatAFileChangedAndOnlyWhenItRests) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path path = folder / "file";
    write_text(path, "a");
    FileWatch watch(path);
    EXPECT_FALSE(watch.look());
    EXPECT_FALSE(watch.look());
    write_text(path, "longer");
    EXPECT_FALSE(watch.look()) << "it may still be written";
    EXPECT_TRUE(watch.look());
    EXPECT_FALSE(watch.look());
}

TEST(FileWatch, SeesAFileThatTookThePlaceOfAnother) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path path = folder / "file", next = folder / "next";
    write_text(path, "a");
    FileWatch watch(path);
    std::filesystem::remove(path);
    EXPECT_FALSE(watch.look());
    EXPECT_FALSE(watch.look()) << "a file that is gone has not changed";
    write_text(next, "b");
    std::filesystem::rename(next, path);
    EXPECT_FALSE(watch.look());
    EXPECT_TRUE(watch.look());
}

TEST(RenderLine, SaysNothingThatIsAsUsual) {
    ViewState state;
    state.width = 80;
    state.height = 60;
    EXPECT_EQ(render_line(state, "a.opal", {{0, 1, 2.5f}, {0, 0, 0}}, "a.png"),
              "opaline render a.opal --light studio --size 80x60 --eye 0,1,2.5 --target 0,0,0 -o "
              "a.png");
}

TEST(RenderLine, NamesAllThatWasChangedAndQuotesNames) {
    ViewState state;
    state.light = "my sky.exr";
    state.fov = 50;
    state.time = -3;
    state.exposure = 0.1f;
    state.tone_map = runtime::ToneMap::none;
    state.coefficients = 20;
    rotate_light_to(state, -90);
    set_emitter(state, "Bob's lamp", {0.5f, 0, 1e-7f});
    toggle_term(state, formats::TermSet::specular);
    const std::string line =
        render_line(state, "a.opal", {{1.1f, 0, 0}, {0, 0, 0}, {1, 0, 0}}, "b c.png");
    EXPECT_EQ(line,
              "opaline render a.opal --light 'my sky.exr' --size 1280x800 --eye 1.1,0,0 --target "
              "0,0,0 --up 1,0,0 --fov 50 --rotate-light 270 --time -3 --terms "
              "multiple,single,diffuse,volume-single,volume-multiple --coefficients 20 --emitter "
              "'Bob'\\''s lamp=0.5,0,1e-07' --exposure 0.1 --tone-map none -o 'b c.png'");
}

TEST(RenderLine, ErrorsByReceiverNeedTheCameraAlone) {
    ViewState state;
    state.error_white = 0.05f;
    state.exposure = 2;
    state.coefficients = 12;
    EXPECT_EQ(render_line(state, "a.opal", {{0, 1, 2.5f}, {0, 0, 0}}, "a.png"),
              "opaline render a.opal --light studio --size 1280x800 --eye 0,1,2.5 --target 0,0,0 "
              "--receiver-errors 0.05 -o a.png");
}

TEST(ViewState, AnEmitterAsAuthoredIsNoChange) {
    ViewState state;
    set_emitter(state, "Lamp", {2, 1, 1});
    set_emitter(state, "Lamp", {0, 0, 0});
    ASSERT_EQ(state.emitters.size(), 1u);
    EXPECT_EQ(emitter_color(state, "Lamp"), (formats::Rgb{0, 0, 0}));
    set_emitter(state, "Lamp", {1, 1, 1});
    EXPECT_TRUE(state.emitters.empty());
}

// Exposure, tone mapper, split and controls change nothing that has to be drawn again.
TEST(ViewState, RadianceIsThatOfTheFinishedPicture) {
    const ViewState state;
    ViewState look = state;
    look.exposure = 3;
    look.tone_map = runtime::ToneMap::none;
    look.split = 0.1f;
    look.panels = false;
    EXPECT_TRUE(same_radiance(state, look));
    look.terms = formats::TermSet::diffuse;
    EXPECT_FALSE(same_radiance(state, look));
    look = state;
    look.error_white = 0.1f;
    EXPECT_FALSE(same_radiance(state, look));
}

}  // namespace

}  // namespace opaline::cli
