// Parts of the example `lamp`.
#include "bake/example/lamp.h"

#include <gtest/gtest.h>

namespace opaline::bake {
namespace {

// Its triangles have an area and face where their vertices' normals do.
void expect_facing_normals(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.position.size(), mesh.normal.size());
    ASSERT_FALSE(mesh.triangles.empty());
    for (const Triangle& t : mesh.triangles) {
        const glm::dvec3 cross = glm::cross(mesh.position[t[1]] - mesh.position[t[0]],
                                            mesh.position[t[2]] - mesh.position[t[0]]);
        EXPECT_GT(glm::dot(cross, mesh.normal[t[0]] + mesh.normal[t[1]] + mesh.normal[t[2]]), 0);
        EXPECT_NEAR(glm::length(mesh.normal[t[0]]), 1, 1e-12);
    }
}

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
        volume += glm::dot(shade.position[t[0]],
                           glm::cross(shade.position[t[1]], shade.position[t[2]])) /
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
