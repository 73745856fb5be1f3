#include "bake/cli/view/view_script.h"

#include <gtest/gtest.h>

#include <string>

namespace opaline::cli {
namespace {

ScriptRun run_of(const char* text) {
    auto steps = parse_script(text, "script");
    EXPECT_TRUE(steps);
    return ScriptRun(steps ? std::move(*steps) : std::vector<ScriptStep>{});
}

ViewState framed_state() {
    ViewState state;
    state.viewpoint.emplace();
    return state;
}

TEST(ScriptRun, AScreenshotWaitsForWhatTheChangesBeforeItAskFor) {
    ScriptRun run = run_of("exposure 1\nscreenshot a.png\nexposure 2\nquit\n");
    ViewState state = framed_state();
    run.advance(state, {.is_settled = true, .settled_frames = 9});  // of the picture before
    EXPECT_EQ(state.exposure, 1);
    EXPECT_FALSE(run.take_shot());
    run.advance(state, {.is_settled = true, .settled_frames = 3});  // controls are not laid out yet
    EXPECT_FALSE(run.take_shot());
    run.advance(state, {.is_settled = true, .settled_frames = 4});
    EXPECT_EQ(state.exposure, 1);
    EXPECT_EQ(run.line(), 2u);
    const auto shot = run.take_shot();
    ASSERT_TRUE(shot);
    EXPECT_EQ(shot->path, "a.png");
    EXPECT_FALSE(run.take_shot());
    EXPECT_FALSE(run.quits());
    run.advance(state, {});
    EXPECT_EQ(state.exposure, 2);
    EXPECT_TRUE(run.quits());
}

TEST(ScriptRun, StepsWaitForFramesReloadsAndTheFirstViewpoint) {
    ScriptRun run = run_of("zoom 2\nwait-frames 2\nwait-reload\nexposure 3\n");
    ViewState state;  // without a viewpoint: nothing was drawn yet
    run.advance(state, {});
    EXPECT_EQ(run.line(), 1u);
    state.viewpoint.emplace();
    for (int frame = 0; frame < 3; ++frame) {
        run.advance(state, {});
        EXPECT_EQ(run.line(), frame < 2 ? 2u : 3u) << frame;
    }
    run.advance(state, {.is_settled = true});
    run.advance(state, {.is_reloaded = true});
    EXPECT_FALSE(state.exposure);
    run.advance(state, {.is_settled = true, .is_reloaded = true});
    EXPECT_EQ(state.exposure, 3);
    EXPECT_FALSE(run.quits());
}

TEST(ScriptRun, IsDoneOnceItsLastChangeIsShown) {
    EXPECT_TRUE(run_of("").is_done());
    ScriptRun run = run_of("load other.opal\n");
    ViewState state = framed_state();
    run.advance(state, {.is_settled = true});
    EXPECT_EQ(state.file, "other.opal");
    state.viewpoint.emplace();
    run.advance(state, {});
    EXPECT_FALSE(run.is_done());  // whether it can be read is not known yet
    EXPECT_EQ(run.line(), 1u);
    run.advance(state, {.is_settled = true});
    EXPECT_TRUE(run.is_done());
    EXPECT_EQ(run.line(), 0u);
}

TEST(ScriptRun, TheNextStepWaitsForAnotherFileSoThatItsFaultHasItsLine) {
    for (const char* change : {"load b.opal", "beside b.opal", "light b.hdr", "drop b.exr"}) {
        for (const char* next : {"exposure 1\n", "quit\n"}) {
            ScriptRun run = run_of((std::string("wait-frames 1\n") + change + "\n" + next).c_str());
            ViewState state = framed_state();
            for (int frame = 0; frame < 5; ++frame) {
                run.advance(state, {.is_settled = frame == 0});
                state.viewpoint.emplace();
            }
            EXPECT_EQ(run.line(), 2u) << change;
            EXPECT_FALSE(run.quits()) << change;
            run.advance(state, {.is_settled = true});
            EXPECT_EQ(run.line(), 3u) << change;
            EXPECT_TRUE(run.quits() || state.exposure == 1) << change;
        }
    }
}

TEST(ScriptRun, AnEmitterThatNoFileHasIsAnError) {
    const std::vector<std::string> lamps{"Lamp"}, suns{"Sun"};
    const ScriptRun::Shown shown{.is_settled = true, .emitters = lamps, .other_emitters = suns};
    ViewState state = framed_state();
    ScriptRun both = run_of("emitter Lamp=0.5\nemitter Sun=2\n");
    both.advance(state, {.is_settled = false});  // the files before have others
    EXPECT_TRUE(state.emitters.empty());
    both.advance(state, shown);
    both.advance(state, shown);
    EXPECT_EQ(emitter_color(state, "Lamp").r, 0.5f);
    EXPECT_EQ(emitter_color(state, "Sun").r, 2);
    EXPECT_FALSE(both.error());
    ScriptRun unknown = run_of("\nemitter Moon=1\n");
    unknown.advance(state, shown);
    ASSERT_TRUE(unknown.error());
    EXPECT_EQ(unknown.line(), 2u);
    EXPECT_NE(unknown.error()->diagnostics.front().remedy.find("Lamp, Sun"), std::string::npos);
}

}  // namespace
}  // namespace opaline::cli
