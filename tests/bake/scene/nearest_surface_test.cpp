#include <gtest/gtest.h>

#include "bake/base/rng.h"
#include "bake/scene/nearest_surface.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

glm::vec3 point_of(const formats::Scene& scene, const NearestSurface::Place& place) {
    const formats::Primitive& p = scene.primitives[place.primitive];
    const auto corner = [&](std::uint32_t k) { return p.position[p.index[place.first_index + k]]; };
    return (1 - place.u - place.v) * corner(0) + place.u * corner(1) + place.v * corner(2);
}

// The least distance to many points of the triangle.
float brute_distance(const formats::Primitive& p, std::size_t first, glm::vec3 at) {
    constexpr int kSteps = 60;
    float least = std::numeric_limits<float>::max();
    const auto corner = [&](std::size_t k) { return p.position[p.index[first + k]]; };
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; i + j <= kSteps; ++j) {
            const float u = static_cast<float>(i) / kSteps, v = static_cast<float>(j) / kSteps;
            const glm::vec3 x = (1 - u - v) * corner(0) + u * corner(1) + v * corner(2);
            least = std::min(least, glm::distance(x, at));
        }
    }
    return least;
}

TEST(NearestSurface, IsTheNearestOfAllTrianglesPoints) {
    formats::Primitive other = tests::make_cube(1, false);
    other.material = 1;
    const formats::Scene scene = tests::make_translucent_scene(
        {other, tests::make_sphere(1), tests::make_cube(2, false)}, {});
    const NearestSurface surface(scene, 0);
    for (std::uint32_t i = 0; i < 60; ++i) {
        const auto u = random_uniform(1, RandomStage::body_walk, 0, i);
        const glm::vec3 at = 3.0f * glm::vec3(u[0], u[1], u[2]) - 1.5f;
        float least = std::numeric_limits<float>::max();
        for (const std::uint32_t p : {1u, 2u}) {
            for (std::size_t k = 0; k < scene.primitives[p].index.size(); k += 3) {
                least = std::min(least, brute_distance(scene.primitives[p], k, at));
            }
        }
        const NearestSurface::Place place = surface.find(at);
        EXPECT_NEAR(place.distance, glm::distance(point_of(scene, place), at), 1e-6f);
        EXPECT_LE(place.distance, least + 1e-5f);
        EXPECT_GE(place.distance, least - 0.02f);
        EXPECT_EQ(surface.find(at, 1.01f * place.distance).first_index, place.first_index);
    }
}

TEST(NearestSurface, TrianglesWithoutAreaAndBodiesWithoutTrianglesDoNoHarm) {
    formats::Primitive line;
    line.position = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
    line.index = {0, 1, 2, 3, 3, 3};
    const formats::Scene scene = tests::make_scene({line});
    EXPECT_FLOAT_EQ(NearestSurface(scene, 0).find({1.5f, 0, 2}).distance, 2);
    EXPECT_FLOAT_EQ(NearestSurface(scene, 0).find({5, 5, 6}).distance, 1);
    const NearestSurface none(tests::make_scene({}), 0);
    EXPECT_TRUE(none.is_empty());
    EXPECT_EQ(none.find({0, 0, 0}).primitive, formats::kNone);
}

TEST(NearestSurface, ManyTrianglesInOnePlaceAreAsOne) {
    formats::Primitive pile;
    pile.position = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < 1000; ++i) {
        pile.index.insert(pile.index.end(), {0, 1, 2});
    }
    const auto place = NearestSurface(tests::make_scene({pile}), 0).find({0.25f, 2, 0.25f});
    EXPECT_FLOAT_EQ(place.distance, 2);
    EXPECT_EQ(place.first_index, 0u) << "the first";
}

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
