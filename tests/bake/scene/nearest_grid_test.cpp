#include "bake/scene/nearest_surface.h"

#include <gtest/gtest.h>

#include "tests/support/media.h"

namespace opaline::bake {
namespace {

TEST(NearestGrid, PointsThatNeighboursHandOnAreTheNearestUpToAShareOfACell) {
    formats::Primitive egg = tests::make_sphere(3);
    for (glm::vec3& p : egg.position) {
        p *= glm::vec3(1, 0.7f, 0.5f);
    }
    const formats::Scene scene =
        tests::make_translucent_scene({egg, tests::make_sphere(2, 0.2f, {0.1f, 0, 0})}, {});
    const NearestSurface surface(scene, 0);
    const GridNodes nodes{{-1.1f, -0.8f, -0.6f}, 0.05f, {45, 33, 25}};
    const auto places = find_nearest(scene, surface, nodes);
    ASSERT_EQ(places.size(), nodes.size());
    for (std::uint32_t z = 0; z < nodes.count.z; z += 2) {
        for (std::uint32_t y = 0; y < nodes.count.y; y += 3) {
            for (std::uint32_t x = 0; x < nodes.count.x; x += 3) {
                const float exact = surface.find(nodes.position(x, y, z)).distance;
                const float found = places[nodes.index(x, y, z)].distance;
                EXPECT_GE(found, exact - 1e-6f);
                EXPECT_LE(found, exact + 0.3f * nodes.cell);
                EXPECT_TRUE(exact > 1.8f * nodes.cell || found < exact + 1e-6f);
            }
        }
    }
}

}  // namespace
}  // namespace opaline::bake
