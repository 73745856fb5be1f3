// Parts of the example `lamp`.
#include "bake/example/scene_parts.h"

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
    double volume = 0;
    const TriangleMesh shade = make_thick_shade({}, 5);
    for (const Triangle& t : shade.triangles) {
        volume +=
            glm::dot(shade.position[t[0]], glm::cross(shade.position[t[1]], shade.position[t[2]])) /
            6;
    }
    // 2 pi times the mean radius times the area of the profile; 48 chords are a little shorter.
    EXPECT_NEAR(volume / (2 * 3.14159265 * 82.5 * 5 * 120), 0.997, 0.003);
}

TEST(LampExample, ShadeAndPanelHaveTheSizeAskedFor) {
    double low = 1e9, high = -1e9, widest = 0;
    for (const glm::dvec3& p : make_shade({}).position) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
        widest = std::max(widest, std::hypot(p.x, p.z));
    }
    EXPECT_NEAR(low, 150, 1e-9);
    EXPECT_NEAR(high, 270, 1e-9);
    EXPECT_NEAR(widest, 105, 1e-9);
    EXPECT_EQ(make_panel({.cells = 3}).triangles.size(), 18u);
}

}  // namespace
}  // namespace opaline::bake
