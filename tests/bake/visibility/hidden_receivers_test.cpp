#include "bake/trace/hidden_receivers.h"

#include <gtest/gtest.h>

#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/touching_triangles.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// A box sunk into a floor of 20 x 20 cells; its sides lie between the floor's vertices.
formats::Scene box_on_floor(bool double_sided) {
    auto scene = tests::make_scene(
        {tests::transformed(tests::make_cube(2, false), glm::mat3(1), 1.05f, {0, 1, 0}),
         tests::make_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 20)});
    scene.materials[0].double_sided = double_sided;
    return scene;
}

std::size_t floor_vertex(const formats::Scene& scene, std::uint32_t row, std::uint32_t column) {
    return scene.primitives[0].position.size() + row * 21 + column;
}

// Of its receivers, once those in bodies have been replaced.
std::vector<double> brightness(const formats::Scene& scene) {
    const RayScene rays = tests::build_rays(scene);
    std::vector<double> all;
    for (const Receiver& receiver :
         replace_hidden_receivers(rays, scene, make_vertex_receivers(scene), {})) {
        all.push_back(tests::white_irradiance(rays, receiver, 8));
    }
    return all;
}

TEST(HiddenReceivers, FloorVerticesUnderABoxTakeOverFromTheirNearestVisibleNeighbour) {
    const auto scene = box_on_floor(false);
    const std::vector<double> seen = brightness(scene);
    // Half a metre a cell: x = 1.0 (column 12) is inside, x = 1.5 (column 13) outside.
    const double outside = seen[floor_vertex(scene, 10, 13)];
    EXPECT_GT(outside, 0);
    EXPECT_EQ(seen[floor_vertex(scene, 10, 12)], outside);
    // Farther inside, no visible point depends on a vertex, so it stays dark.
    EXPECT_EQ(seen[floor_vertex(scene, 10, 10)], 0);
    // Visible vertices stay unchanged.
    const RayScene rays = tests::build_rays(scene);
    const std::vector<Receiver> before = make_vertex_receivers(scene);
    const std::size_t open = floor_vertex(scene, 3, 3);
    EXPECT_EQ(replace_hidden_receivers(rays, scene, before, {})[open].origin, before[open].origin);
}

TEST(HiddenReceivers, DoubleSidedBodiesAndClosedRoomsStayDarkInside) {
    const auto box = box_on_floor(true);
    EXPECT_EQ(brightness(box)[floor_vertex(box, 10, 12)], 0);
    for (const double seen : brightness(tests::make_scene({tests::make_cube(3, true)}))) {
        ASSERT_EQ(seen, 0);
    }
}

// A floor's vertex in the wall of a dark room, nearer to the one at the wall's outer face than to
// that in the room: its triangles show in the room alone.
TEST(HiddenReceivers, AFloorsVertexInAWallTakesTheSideOnWhichItsTrianglesShow) {
    formats::Scene scene = tests::make_scene(
        {tests::transformed(tests::make_cube(1, false), glm::mat3(1), 1.1f, {0, 0.3f, 0}),
         tests::transformed(tests::make_cube(1, true), glm::mat3(1), 1, {0, 0.3f, 0}),
         tests::make_quad({0, 0, -0.5f}, {0, 0, 1}, {2, 0, 0}, 2)});
    formats::Primitive& floor = scene.primitives[2];
    for (glm::vec3& x : floor.position) {
        x.x = x.x == 0 ? 0.5f : x.x == 1 ? 1.06f : 1.1f;
    }
    const RayScene rays = tests::build_rays(scene);
    const std::vector<Receiver> receivers =
        leave_touching_triangles(rays.hierarchy(), scene, make_vertex_receivers(scene), {});
    const std::vector<Receiver> seen = replace_hidden_receivers(rays, scene, receivers, {});
    for (std::size_t v = seen.size() - 9; v < seen.size(); ++v) {
        const float at = floor.position[v - (seen.size() - 9)].x;
        EXPECT_EQ(tests::white_irradiance(rays, seen[v], 8) > 0, at == 1.1f) << at;
    }
}

TEST(HiddenReceivers, WhatStandsInClearGlassIsSeen) {
    auto scene = box_on_floor(false);
    scene.primitives[0].material = 1;
    scene.materials.resize(2);
    scene.materials[1].medium.emplace().sigma_s = {0, 0, 0};
    EXPECT_FALSE(is_hidden(tests::build_rays(scene), {{0, 0.1f, 0}, {0, 1, 0}}));
    scene.materials[1].medium->sigma_s = {1, 1, 1};
    EXPECT_TRUE(is_hidden(tests::build_rays(scene), {{0, 0.1f, 0}, {0, 1, 0}}));
}

}  // namespace
}  // namespace opaline::bake
