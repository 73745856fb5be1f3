#include "bake/scene/base_color.h"

#include <gtest/gtest.h>

namespace opaline::bake {
namespace {

using formats::Rgb;

/// A triangle whose material glows; with a texture, 1 on its left half and 0 on its right.
formats::Scene glowing_triangle(bool textured) {
    formats::Scene scene;
    scene.materials.resize(1);
    scene.materials[0].emission = {10, 20, 30};
    formats::Primitive& p = scene.primitives.emplace_back();
    p.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.texcoord = {{0.25f, 0.5f}, {0.75f, 0.5f}, {0.25f, 0.5f}};
    p.index = {0, 1, 2};
    if (textured) {
        scene.materials[0].emission_image = 0;
        scene.images.push_back({2, 1, {255, 255, 255, 255, 0, 0, 0, 255}});
    }
    return scene;
}

TEST(Emission, WithoutATextureItIsTheFactor) {
    const formats::Scene scene = glowing_triangle(false);
    EXPECT_TRUE(is_emissive(scene.materials[0]));
    EXPECT_FALSE(is_emissive(formats::Material{}));
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0.2f, 0.3f, 0.5f}), (Rgb{10, 20, 30}));
}

TEST(Emission, TheTextureIsLookedUpBetweenTexelsInLinearLight) {
    const formats::Scene scene = glowing_triangle(true);
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {1, 0, 0}), (Rgb{10, 20, 30}));
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0, 1, 0}), (Rgb{0, 0, 0}));
    EXPECT_NEAR(emission_at(scene, 0, {0, 1, 2}, {0.5f, 0.5f, 0}).g, 10, 1e-4f);
}

TEST(Emission, WithoutCoordinatesOrPixelsTheFactorCounts) {
    formats::Scene scene = glowing_triangle(true);
    scene.images[0] = {};
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0, 1, 0}), (Rgb{10, 20, 30}));
    scene = glowing_triangle(true);
    scene.primitives[0].texcoord.clear();
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0, 1, 0}), (Rgb{10, 20, 30}));
}

}  // namespace
}  // namespace opaline::bake
