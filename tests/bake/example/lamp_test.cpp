// Parts of the example `lamp`.
#include "bake/lab/example/scene_parts.h"

#include <gtest/gtest.h>

#include "tests/bake/example/facing.h"

namespace opaline::bake {
namespace {

TEST(LampExample, SurfacesFaceOutward) {
    expect_facing_normals(make_shade({}));
    expect_facing_normals(make_thick_shade({}, 5));
    expect_facing_normals(make_lamp_foot());
    expect_facing_normals(make_panel({}));
    expect_facing_normals(make_wall());
}

TEST(LampExample, ThickShadeIsClosed) {
    const double volume = enclosed_volume(make_thick_shade({}, 5));
    // 2 pi times the mean radius times the area of the profile; 48 chords are a little shorter.
    EXPECT_NEAR(volume / (2 * 3.14159265 * 82.5 * 5 * 120), 0.997, 0.003);
}

}  // namespace
}  // namespace opaline::bake
