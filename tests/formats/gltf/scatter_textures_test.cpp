#include <gmock/gmock.h>

#include "tests/formats/gltf/asset_builder.h"
#include "tests/formats/gltf/encode_test_image.h"

namespace opaline::tests {
namespace {

using formats::kNone;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Blob kPixels = {255, 0, 0, 255, 0, 128, 255, 64};

/// The triangle with texture coordinates and a scattering medium, and a texture for it.
AssetBuilder asset_with_scatter(Json scatter) {
    scatter["scatterStrengthFactor"] = 0.75;
    scatter["scatterAnisotropy"] = 0.5;
    AssetBuilder asset =
        textured_triangle({{"name", "Wax"},
                           {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                           {"extensions",
                            {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                             {"KHR_materials_volume",
                              {{"thicknessFactor", 1},
                               {"attenuationDistance", 0.02},
                               {"attenuationColor", {0.9, 0.5, 0.25}}}},
                             {"KHR_materials_scatter", std::move(scatter)}}}},
                          0.5f);
    asset.json["samplers"] = Json::array({{{"wrapT", 33071}}});
    add_texture(asset, encode_png(kPixels, 2, 1), {{"name", "Grain"}}, {{"sampler", 0u}});
    return asset;
}

const formats::Variation& variation_of(const formats::Scene& scene) {
    return scene.materials.at(0).medium.value().variation.value();
}

TEST(GltfScatterTextures, BothActInsideTheMediumAndShareAnImage) {
    const auto imported = must_import(
        asset_with_scatter({{"multiscatterColorTexture", {{"index", 0u}}},
                            {"scatterStrengthTexture", {{"index", 0u}, {"texCoord", 0u}}}}));
    EXPECT_EQ(lines(imported.warnings), "");
    const formats::Variation& variation = variation_of(imported.scene);
    EXPECT_EQ(variation.color.image, 0u);
    EXPECT_EQ(variation.strength.image, 0u);
    EXPECT_EQ(variation.density.image, kNone);
    EXPECT_EQ(variation.g, 0.5f);
    EXPECT_EQ(variation.color.wrap_u, formats::TextureWrap::repeat);
    EXPECT_EQ(variation.color.wrap_v, formats::TextureWrap::clamp);
    ASSERT_EQ(imported.scene.inner_images.size(), 1u);
    EXPECT_EQ(imported.scene.inner_images[0].rgba, kPixels);
    EXPECT_TRUE(imported.scene.images.empty()) << "no file keeps them";
    EXPECT_EQ(imported.scene.materials[0].base_color_image, kNone);
}

TEST(GltfScatterTextures, TakeTheirOwnCoordinatesWhereTheBaseColorHasNone) {
    const auto imported = must_import(asset_with_scatter(
        {{"multiscatterColorTexture",
          {{"index", 0u},
           {"texCoord", 0u},
           {"extensions",
            {{"KHR_texture_transform",
              {{"texCoord", 1u}, {"offset", {0.25, 0}}, {"scale", {2, 4}}}}}}}}}));
    EXPECT_THAT(imported.scene.primitives.at(0).texcoord,
                ElementsAre(glm::vec2(0.25f, 0), glm::vec2(1.25f, 0), glm::vec2(0.25f, 2)));
}

TEST(GltfScatterTextures, OneMappedOtherwiseThanTheBaseColorIsNamedAndNotUsed) {
    AssetBuilder asset =
        asset_with_scatter({{"multiscatterColorTexture", {{"index", 0u}, {"texCoord", 1u}}},
                            {"scatterStrengthTexture", {{"index", 0u}}}});
    asset.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0u}};
    const auto imported = must_import(asset);
    EXPECT_THAT(lines(imported.warnings),
                HasSubstr("multiscatterColorTexture is mapped otherwise"));
    EXPECT_EQ(variation_of(imported.scene).color.image, kNone);
    EXPECT_EQ(variation_of(imported.scene).strength.image, 0u);
    EXPECT_EQ(imported.scene.images.size(), 1u);
}

TEST(GltfScatterTextures, WithoutAnInsideTheyAreNamedAndNotUsed) {
    AssetBuilder asset = asset_with_scatter({{"multiscatterColorTexture", {{"index", 0u}}}});
    asset.json["materials"][0]["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 0;
    const auto imported = must_import(asset);
    EXPECT_TRUE(imported.scene.materials.at(0).sheet);
    EXPECT_TRUE(imported.scene.inner_images.empty());
    EXPECT_THAT(lines(imported.warnings), HasSubstr("multiscatterColorTexture is not simulated"));
}

TEST(GltfScatterTextures, FaultyOnesAreErrorsThatNameTheElement) {
    const Json wrong = Json::array(
        {5,
         Json::object(),
         {{"index", -1}},
         {{"index", "0"}},
         {{"index", 1e300}},
         {{"index", 0u}, {"texCoord", 256}},
         {{"index", 0u}, {"extensions", {{"KHR_texture_transform", 1}}}},
         {{"index", 0u}, {"extensions", {{"KHR_texture_transform", {{"offset", {1}}}}}}},
         {{"index", 0u}, {"extensions", {{"KHR_texture_transform", {{"rotation", "x"}}}}}}});
    for (const Json& info : wrong) {
        EXPECT_THAT(errors_of(import_asset(asset_with_scatter({{"scatterStrengthTexture", info}}))),
                    HasSubstr("KHR_materials_scatter > scatterStrengthTexture"))
            << info;
    }
    EXPECT_THAT(
        errors_of(import_asset(asset_with_scatter({{"scatterStrengthTexture", {{"index", 7u}}}}))),
        HasSubstr("material 'Wax'"));
    AssetBuilder damaged = asset_with_scatter({{"scatterStrengthTexture", {{"index", 0u}}}});
    damaged.json["images"][0] = {{"name", "Grain"}, {"uri", "none.png"}};
    EXPECT_THAT(errors_of(import_asset(damaged)), HasSubstr("'Grain'"));
}

}  // namespace
}  // namespace opaline::tests
