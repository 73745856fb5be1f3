#include "bake/cli/view/render_line.h"

#include <gtest/gtest.h>

namespace opaline::cli {
namespace {

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

}  // namespace
}  // namespace opaline::cli
