#include "bake/cli/view/view_script.h"

#include <gmock/gmock.h>

#include "bake/cli/view/orbit_camera.h"

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

}  // namespace
}  // namespace opaline::cli
