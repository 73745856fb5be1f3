#include "bake/cli/view/script_run.h"

#include <gtest/gtest.h>

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
    EXPECT_TRUE(run.quits() && run.is_done());
    EXPECT_EQ(run.line(), 0u);
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
    EXPECT_EQ(state.exposure, 0);
    run.advance(state, {.is_settled = true, .is_reloaded = true});
    EXPECT_EQ(state.exposure, 3);
    EXPECT_TRUE(run.is_done());
    EXPECT_FALSE(run.quits());
}

}  // namespace
}  // namespace opaline::cli
