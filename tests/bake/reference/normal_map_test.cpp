#include <gtest/gtest.h>

#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

// A white floor whose normal map tilts it evenly toward u, which grows toward +x.
Scene tilted_floor(std::uint8_t x, std::uint8_t z, float sign) {
    Scene scene = make_scene({make_quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100})});
    formats::Primitive& floor = scene.primitives[0];
    floor.texcoord.assign(4, {0.5f, 0.5f});
    floor.tangent.assign(4, {sign, 0, 0, sign});
    scene.images.push_back({1, 1, {x, 128, z, 255}});
    scene.materials[0].normal_image = 0;
    return scene;
}

float seen_under_sun(Scene scene, glm::vec3 travel) {
    scene.lights.push_back(unit_sun(travel));
    const auto fixture = make_fixture(std::move(scene), {});
    return static_cast<float>(look(fixture->space(), {0.2f, 2, 0.1f}, {0, -1, 0}, 16).mean.x);
}

TEST(ReferenceNormalMap, TiltsTheCosineOfASunAndKeepsTheTrianglesSides) {
    const glm::vec3 mapped = glm::normalize(glm::vec3(43, 119, 0));
    for (const float sign : {1.0f, -1.0f}) {
        const Scene scene = tilted_floor(128 + 43, 128 + 119, sign);
        for (const glm::vec3 travel : {glm::vec3(-1, -2, 0.3f), glm::vec3(1, -2, 0.3f)}) {
            const glm::vec3 normal(sign * mapped.x, mapped.y, 0);
            EXPECT_NEAR(seen_under_sun(scene, travel), glm::dot(normal, -glm::normalize(travel)),
                        1e-5f);
        }
        // Grazing from below: the tilted normal would see it, the triangle does not.
        EXPECT_EQ(seen_under_sun(scene, {-sign, 0.05f, 0}), 0);
    }
}

TEST(ReferenceNormalMap, FlatOneIsTheVerticesNormal) {
    EXPECT_NEAR(seen_under_sun(tilted_floor(128, 255, 1), {-1, -2, 0.3f}),
                seen_under_sun(tilted_floor(128, 128, 1), {-1, -2, 0.3f}), 1e-6f);
}

}  // namespace
}  // namespace opaline::tests
