#include "bake/trace/contacts.h"

#include <gtest/gtest.h>

#include <numeric>

#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
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

}  // namespace
}  // namespace opaline::bake
