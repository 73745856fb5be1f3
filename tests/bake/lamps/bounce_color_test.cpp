#include "bake/exchange/lamps/onward_ray.h"

#include <gtest/gtest.h>

#include "tests/bake/lamps/lamp_scenes.h"

namespace opaline::bake {
namespace {

const glm::vec3 kMiddle(1.0f / 3);

formats::Scene coloured_quad() {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 1).base_color = {
        0.8f, 0.4f, 0.2f};
    return scene;
}

TEST(BounceColor, OfAnOpaqueSurfaceIsItsBaseColourInFront) {
    formats::Scene scene = coloured_quad();
    EXPECT_EQ(bounce_color(scene, {0, 0}, kMiddle).reflect,
              glm::dvec3(glm::vec3(0.8f, 0.4f, 0.2f)));
    EXPECT_EQ(bounce_color(scene, {0, 0, true}, kMiddle).reflect, glm::dvec3(0));
    scene.materials[0].double_sided = true;
    EXPECT_GT(bounce_color(scene, {0, 0, true}, kMiddle).reflect.x, 0.7);
    scene.materials[0].gloss.metallic = 0.75f;
    EXPECT_NEAR(bounce_color(scene, {0, 0}, kMiddle).reflect.y, 0.1, 1e-6);
}

TEST(BounceColor, ThinWallsPassAShareToTheOtherSideAndMediaKeepAll) {
    formats::Scene scene = coloured_quad();
    scene.materials[0].sheet = formats::Sheet{{0.5f, 0.5f, 0.5f}, {0.25f, 0.25f, 0.25f}};
    for (const bool is_back : {false, true}) {
        const BounceColor color = bounce_color(scene, {0, 0, is_back}, kMiddle);
        EXPECT_NEAR(color.reflect.x, 0.4, 1e-6);
        EXPECT_NEAR(color.transmit.x, 0.2, 1e-6);
    }
    scene.materials[0].sheet.reset();
    scene.materials[0].medium.emplace();
    EXPECT_EQ(bounce_color(scene, {0, 0}, kMiddle).reflect, glm::dvec3(0));
}

}  // namespace
}  // namespace opaline::bake
