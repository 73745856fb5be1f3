#include "bake/cli/view/view_state.h"

#include <gtest/gtest.h>

namespace opaline::cli {
namespace {

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
