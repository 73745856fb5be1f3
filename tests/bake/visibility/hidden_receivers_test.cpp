#include "bake/transport/hidden_receivers.h"

#include <gtest/gtest.h>

#include "bake/receivers/vertex_receivers.h"
#include "bake/transport/irradiance_transport.h"
#include "formats/opal/cubemap.h"
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

double brightness(const RayScene& rays, const Receiver& receiver) {
    std::vector<float> transport(formats::cubemap_texels(8));
    gather_irradiance(rays, make_direction_set(8), receiver, transport);
    double sum = 0;
    for (const float value : transport) {
        sum += value;
    }
    return sum;
}

TEST(HiddenReceivers, FloorVerticesUnderABoxTakeOverFromTheirNearestVisibleNeighbour) {
    const auto scene = box_on_floor(false);
    const auto rays = RayScene::build(scene, 1);
    ASSERT_TRUE(rays);
    const std::vector<Receiver> set =
        replace_hidden_receivers(*rays, scene, make_vertex_receivers(scene), {});
    // Half a metre a cell: x = 1.0 (column 12) is inside, x = 1.5 (column 13) outside.
    const double inside = brightness(*rays, set[floor_vertex(scene, 10, 12)]);
    const double outside = brightness(*rays, set[floor_vertex(scene, 10, 13)]);
    EXPECT_GT(outside, 0);
    EXPECT_EQ(inside, outside);
    // Farther inside, no visible point depends on a vertex, so it stays dark.
    EXPECT_EQ(brightness(*rays, set[floor_vertex(scene, 10, 10)]), 0);
    // Visible vertices stay unchanged.
    const std::size_t open = floor_vertex(scene, 3, 3);
    EXPECT_EQ(set[open].origin, make_vertex_receivers(scene)[open].origin);
}

TEST(HiddenReceivers, InteriorsOfDoubleSidedBodiesStayDark) {
    const auto scene = box_on_floor(true);
    const auto rays = RayScene::build(scene, 1);
    ASSERT_TRUE(rays);
    const std::vector<Receiver> set =
        replace_hidden_receivers(*rays, scene, make_vertex_receivers(scene), {});
    EXPECT_EQ(brightness(*rays, set[floor_vertex(scene, 10, 12)]), 0);
}

TEST(HiddenReceivers, ClosedRoomsSeenFromInsideStayDark) {
    const auto scene = tests::make_scene({tests::make_cube(3, true)});
    const auto rays = RayScene::build(scene, 1);
    ASSERT_TRUE(rays);
    const std::vector<Receiver> set =
        replace_hidden_receivers(*rays, scene, make_vertex_receivers(scene), {});
    for (std::size_t i = 0; i < set.size(); ++i) {
        ASSERT_EQ(brightness(*rays, set[i]), 0);
    }
}

}  // namespace
}  // namespace opaline::bake
