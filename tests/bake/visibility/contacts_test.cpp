#include <gtest/gtest.h>

#include <numeric>
#include <utility>

#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/contacts.h"
#include "bake/trace/touching_triangles.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using tests::build_rays;
using tests::white_irradiance;

std::vector<Receiver> rest_beside(const formats::Scene& scene, const RayScene& rays) {
    std::vector<Receiver> receivers =
        leave_touching_triangles(rays.hierarchy(), scene, make_vertex_receivers(scene), {});
    std::vector<BodyPoint> inside = make_body_points(scene, receivers);
    std::vector<std::uint32_t> all(receivers.size());
    std::iota(all.begin(), all.end(), 0u);
    look_beside_contacts(find_contacts(rays.hierarchy(), scene, all, {}), receivers, inside);
    return receivers;
}

formats::Primitive make_box(glm::vec3 low, glm::vec3 high, std::uint32_t cells = 2) {
    formats::Primitive box = tests::make_cube(cells, false);
    for (glm::vec3& p : box.position) {
        p = glm::mix(low, high, 0.5f * (p + 1.0f));
    }
    return box;
}

// Of a scene whose first primitive stands on a floor that nothing shines on from below.
void expect_feet_see_the_sky(const formats::Scene& scene, std::size_t feet) {
    const RayScene rays = build_rays(scene);
    const std::vector<Receiver> receivers = rest_beside(scene, rays);
    const formats::Primitive& body = scene.primitives[0];
    std::size_t seen = 0;
    for (std::size_t v = 0; v < body.position.size(); ++v) {
        if (body.position[v].y == 0 && body.normal[v].y == 0) {
            ++seen;
            EXPECT_NEAR(white_irradiance(rays, receivers[v], 16), 0.5, 0.03) << v;
        }
    }
    EXPECT_EQ(seen, feet);
}

TEST(Contacts, TheFootOfABoxOnAFloorSeesTheSkyAboveTheFloor) {
    const auto box = make_box({-1, 0, -1}, {1, 2, 1});
    // The lower quad keeps light away that would come from below.
    for (const std::uint32_t cells : {1u, 16u, 3u}) {
        SCOPED_TRACE(cells);  // of 16, some meet at the feet
        expect_feet_see_the_sky(
            tests::make_scene({box, tests::make_quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0}, cells),
                               tests::make_quad({-9, -1, -9}, {0, 0, 18}, {18, 0, 0})}),
            12);
    }
}

TEST(Contacts, ARoomOfWallsThatTouchIsDark) {
    const auto scene = tests::make_scene({tests::make_quad({-2, 0, -2.5f}, {0, 0, 5}, {4, 0, 0}),
                                          tests::make_quad({-2, 2.5f, -2.5f}, {4, 0, 0}, {0, 0, 5}),
                                          make_box({-2.1f, 0, -2.5f}, {-2, 2.5f, 2.5f}),
                                          make_box({2, 0, -2.5f}, {2.1f, 2.5f, 2.5f}),
                                          make_box({-2.1f, 0, -2.6f}, {2.1f, 2.5f, -2.5f}),
                                          make_box({-2.1f, 0, 2.5f}, {2.1f, 2.5f, 2.6f})});
    const RayScene rays = build_rays(scene);
    const std::vector<Receiver> receivers = rest_beside(scene, rays);
    std::size_t v = 0, inside = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i < p.position.size(); ++i, ++v) {
            const glm::vec3 ahead = p.position[i] + 0.1f * p.normal[i];
            if (glm::any(glm::greaterThan(glm::abs(ahead - glm::vec3(0, 1.25f, 0)),
                                          glm::vec3(2, 1.25f, 2.5f)))) {
                continue;
            }
            ++inside;
            EXPECT_NEAR(white_irradiance(rays, receivers[v], 8), 0, 1e-6)
                << v << ' ' << p.position[i].x << ' ' << p.position[i].y << ' ' << p.position[i].z;
        }
    }
    EXPECT_EQ(inside, 32u);
}

TEST(Contacts, VerticesThatTouchNothingStayBitByBit) {
    const auto scene = tests::make_scene(
        {tests::transformed(tests::make_sphere(3), tests::some_rotation(), 0.3f, {1, 2, 3}),
         make_box({-1, 0.01f, -1}, {1, 2, 1}),
         tests::make_quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0}, 3)});
    const RayScene rays = build_rays(scene);
    const auto before = make_vertex_receivers(scene);
    const auto after = rest_beside(scene, rays);
    for (std::size_t v = 0; v < after.size(); ++v) {
        EXPECT_EQ(before[v].origin, after[v].origin) << v;
    }
}

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
