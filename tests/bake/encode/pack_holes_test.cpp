#include "bake/encode/pack_asset.h"

#include <gmock/gmock.h>

#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using formats::HoleMode;
using formats::HoleRecord;
using formats::Holes;
using formats::Material;
using formats::PreviewImageData;
using formats::Scene;

// Two sheets whose alpha has an image, one with that of its vertices, and one that is whole.
Scene scene_with_holes() {
    Scene scene = tests::make_scene(
        {tests::make_quad({}, {1, 0, 0}, {0, 1, 0}), tests::make_quad({}, {1, 0, 0}, {0, 1, 0}),
         tests::make_quad({}, {1, 0, 0}, {0, 1, 0}), tests::make_quad({}, {1, 0, 0}, {0, 1, 0})});
    scene.images.push_back({2, 1, {1, 2, 3, 51, 4, 5, 6, 255}});
    scene.materials.resize(4);
    for (std::uint32_t p = 0; p < 4; ++p) {
        formats::Primitive& primitive = scene.primitives[p];
        primitive.material = p;
        primitive.texcoord.assign(primitive.position.size(), {0.25f, 0.5f});
    }
    scene.materials[1].alpha_mode = Material::AlphaMode::mask;
    scene.materials[1].alpha_cutoff = 0.3f;
    scene.materials[1].base_color_image = 0;
    scene.materials[2].alpha_mode = Material::AlphaMode::blend;
    scene.materials[2].alpha = 0.75f;
    scene.materials[2].base_color_image = 0;
    scene.materials[3].alpha_mode = Material::AlphaMode::blend;
    return scene;
}

TEST(PackHoles, SheetsOfOneImageShareItsAlpha) {
    std::vector<PreviewImageData> images(1);
    const Holes holes = pack_holes(scene_with_holes(), images);
    ASSERT_EQ(holes.record.size(), 3u);
    EXPECT_EQ(holes.record[0].primitive, 1u);
    EXPECT_EQ(holes.record[0].mode, HoleMode::mask);
    EXPECT_EQ(holes.record[0].cutoff, 0.3f);
    EXPECT_EQ(holes.record[1].mode, HoleMode::blend);
    EXPECT_EQ(holes.record[1].alpha, 0.75f);
    EXPECT_EQ(holes.record[0].image, 1u);
    EXPECT_EQ(holes.record[1].image, 1u);
    EXPECT_EQ(holes.record[2].image, formats::kNoImage);
    ASSERT_EQ(images.size(), 2u);
    EXPECT_THAT(images[1].rgb, ::testing::ElementsAre(51, 51, 51, 255, 255, 255));
    EXPECT_TRUE(holes.vertex_alpha.empty());
}

TEST(PackHoles, VerticesKeepTheirAlphaWhereTheMaterialHasHoles) {
    Scene scene = scene_with_holes();
    scene.primitives[0].alpha.assign(4, 0.1f);
    std::vector<PreviewImageData> images(1);
    EXPECT_TRUE(pack_holes(scene, images).vertex_alpha.empty());
    scene.primitives[3].alpha = {0, 0.25f, 0.5f, 2};
    EXPECT_THAT(pack_holes(scene, images).vertex_alpha,
                ::testing::ElementsAre(1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0.25f, 0.5f, 1));
}

}  // namespace
}  // namespace opaline::bake
