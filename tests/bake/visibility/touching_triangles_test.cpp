#include "bake/trace/touching_triangles.h"

#include <gtest/gtest.h>

#include <utility>

#include "bake/receivers/vertex_receivers.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using tests::build_rays;
using tests::white_irradiance;

std::vector<Receiver> placed(const formats::Scene& scene, const RayScene& rays) {
    return leave_touching_triangles(rays.hierarchy(), scene, make_vertex_receivers(scene), {});
}

// A floor of 8 x 8 cells whose edge x = -1 meets a wall of one cell: seven of the floor's vertices
// lie on the wall's edge.
formats::Scene floor_at_a_coarse_wall(const glm::mat3& turned, glm::vec3 offset) {
    return tests::make_scene(
        {tests::transformed(tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 8), turned, 1,
                            offset),
         tests::transformed(tests::make_quad({-1, 0, -1}, {0, 50, 0}, {0, 0, 2}), turned, 1,
                            offset)});
}

TEST(TouchingTriangles, AFloorAtACoarseWallSeesHalfOfTheLightAllAlongTheEdge) {
    const std::pair<glm::mat3, glm::vec3> places[] = {
        {glm::mat3(1), glm::vec3(0)},
        {tests::some_rotation(), glm::vec3(0)},
        {tests::some_rotation(), glm::vec3(30, -20, 5)}};
    for (const auto& [turned, offset] : places) {
        const auto scene = floor_at_a_coarse_wall(turned, offset);
        const RayScene rays = build_rays(scene);
        const auto receivers = placed(scene, rays);
        std::size_t on_edge = 0;
        for (std::size_t v = 0; v < 81; ++v) {
            const glm::vec3 place =
                glm::transpose(turned) * (scene.primitives[0].position[v] - offset);
            const bool is_middle = std::abs(place.z) < 0.6f && std::abs(place.x + 1) < 1e-4f;
            if (is_middle) {
                ++on_edge;
                EXPECT_NEAR(white_irradiance(rays, receivers[v], 16), 0.5, 0.02) << v;
            }
        }
        EXPECT_EQ(on_edge, 5u);
    }
}

TEST(TouchingTriangles, AWallInTheMiddleOfAFloorStartsItsRaysAboveTheFloor) {
    const auto scene = tests::make_scene({tests::make_quad({-3, 0, -2}, {0, 0, 5}, {7, 0, 0}),
                                          tests::make_quad({0, 0, -1}, {0, 1, 0}, {0, 0, 2}, 4)});
    const RayScene rays = build_rays(scene);
    const auto before = make_vertex_receivers(scene);
    const auto after = placed(scene, rays);
    std::size_t moved = 0;
    for (std::size_t v = 4; v < after.size(); ++v) {
        const glm::vec3 position = scene.primitives[1].position[v - 4];
        if (position.y == 0) {
            ++moved;
            EXPECT_EQ(before[v].origin.y, 0) << v;
            EXPECT_GT(after[v].origin.y, 0) << v;
            EXPECT_GT(glm::dot(after[v].origin - position, after[v].normal), 0) << v;
            EXPECT_LT(glm::distance(after[v].origin, position), 1e-4f) << v;
        } else {
            EXPECT_EQ(before[v].origin, after[v].origin) << v;
        }
    }
    EXPECT_EQ(moved, 5u);
}

void expect_unmoved(const formats::Scene& scene) {
    const RayScene rays = build_rays(scene);
    const auto before = make_vertex_receivers(scene);
    const auto after = placed(scene, rays);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t v = 0; v < after.size(); ++v) {
        EXPECT_EQ(before[v].origin, after[v].origin) << v;
    }
}

TEST(TouchingTriangles, ReceiversThatNothingTouchesStayBitByBit) {
    for (const auto& body : {tests::make_sphere(3), tests::make_cube(5, false)}) {
        SCOPED_TRACE(body.name);
        expect_unmoved(
            tests::make_scene({tests::transformed(body, tests::some_rotation(), 0.3f, {1, 2, 3})}));
    }
}

// Up and down at once: nothing is in front of both.
TEST(TouchingTriangles, UnderABoxThatStandsOnAFloorNothingMoves) {
    expect_unmoved(tests::make_scene(
        {tests::transformed(tests::make_cube(2, false), glm::mat3(1), 1, {0.1f, 1, 0.2f}),
         tests::make_quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0})}));
}

TEST(TouchingTriangles, ThousandsOfTrianglesThroughOnePointAreGivenUp) {
    auto pile = tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    const auto once = pile.index;
    for (int i = 0; i < 5000; ++i) {
        pile.index.insert(pile.index.end(), once.begin(), once.end());
    }
    expect_unmoved(
        tests::make_scene({pile, tests::make_quad({0, 0, -0.5f}, {0, 1, 0}, {0, 0, 1}, 2)}));
}

}  // namespace
}  // namespace opaline::bake
