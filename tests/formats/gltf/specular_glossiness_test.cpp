#include "tests/formats/gltf/encode_test_image.h"

namespace opaline::tests {
namespace {

using formats::Material;
using formats::Rgb;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// A triangle with texture coordinates whose material is `extension`.
AssetBuilder specular_asset(const Json& extension) {
    // What other readers fall back on does not count.
    return textured_triangle({{"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.1, 0.1, 1}}}},
                              {"extensions", {{kSpecularGlossiness, extension}}}});
}

std::size_t add_specular_texture(AssetBuilder& asset, const Blob& rgba, std::uint32_t width) {
    return add_texture(asset, encode_png(rgba, width, 1));
}

TEST(GltfSpecularGlossiness, FactorsBecomeAnInfiniteIndexOfThatSpecularColour) {
    AssetBuilder asset = specular_asset({{"diffuseFactor", {0.2, 0.5, 0.8, 0.5}},
                                         {"specularFactor", {0.25, 0.5, 0}},
                                         {"glossinessFactor", 0.75}});
    asset.json["materials"][0]["alphaMode"] = "BLEND";
    asset.json["extensionsRequired"] = {kSpecularGlossiness};
    const auto imported = must_import(asset);
    const Material& m = imported.scene.materials.at(0);
    EXPECT_EQ(m.base_color, (Rgb{0.2f, 0.5f, 0.8f}));
    EXPECT_EQ(m.alpha, 0.5f);
    EXPECT_EQ(m.gloss.metallic, 0.0f);
    EXPECT_EQ(m.gloss.ior, 0.0f);
    EXPECT_EQ(m.gloss.specular, 1.0f);
    EXPECT_EQ(m.gloss.specular_color, (Rgb{0.25f, 0.5f, 0}));
    EXPECT_EQ(m.gloss.roughness, 0.25f);
    EXPECT_THAT(lines(imported.warnings), Not(HasSubstr("pbrSpecularGlossiness")));
}

TEST(GltfSpecularGlossiness, DiffuseTextureIsTheBaseColour) {
    AssetBuilder asset = specular_asset(Json::object());
    asset.json["materials"][0]["extensions"][kSpecularGlossiness]["diffuseTexture"]["index"] =
        add_specular_texture(asset, {255, 0, 0, 255}, 1);
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.materials.at(0).base_color_image, 0u);
    EXPECT_EQ(imported.scene.images.at(0).rgba[0], 255);
}

TEST(GltfSpecularGlossiness, MetalsOfATextureAreFoundTexelByTexel) {
    // A matt red dielectric of F0 = .04 (code 56 is .0395), and gold: no diffuse part.
    AssetBuilder asset = specular_asset(Json::object());
    Json& material = asset.json["materials"][0]["extensions"][kSpecularGlossiness];
    material["diffuseTexture"]["index"] =
        add_specular_texture(asset, {200, 10, 10, 255, 0, 0, 0, 128}, 2);
    material["specularGlossinessTexture"]["index"] =
        add_specular_texture(asset, {56, 56, 56, 0, 255, 219, 145, 204}, 2);
    const auto imported = must_import(asset);
    const Material& m = imported.scene.materials.at(0);
    ASSERT_EQ(imported.scene.images.size(), 2u) << "nothing that no material uses";
    const auto& base = imported.scene.images[m.base_color_image].rgba;
    const auto& gloss = imported.scene.images[m.gloss.image].rgba;
    EXPECT_EQ(m.base_color, (Rgb{1, 1, 1}));
    EXPECT_NEAR(base[0], 200, 1);
    EXPECT_NEAR(base[1], 10, 1);
    EXPECT_EQ(gloss[1], 255);  // roughness
    EXPECT_EQ(gloss[2], 0);    // metallic
    EXPECT_NEAR(base[4], 255, 1);
    EXPECT_NEAR(base[5], 219, 2);
    EXPECT_NEAR(base[6], 145, 2);
    EXPECT_EQ(base[7], 128);
    EXPECT_EQ(gloss[5], 51);
    EXPECT_EQ(gloss[6], 255);
    EXPECT_EQ(m.gloss.ior, 1.5f);
}

TEST(GltfSpecularGlossiness, ATextureMappedOtherwiseGivesItsMean) {
    AssetBuilder asset = specular_asset({{"glossinessFactor", 0.5}});
    Json& material = asset.json["materials"][0]["extensions"][kSpecularGlossiness];
    material["diffuseTexture"]["index"] = add_specular_texture(asset, {9, 9, 9, 255}, 1);
    material["specularGlossinessTexture"] = {
        {"index", add_specular_texture(asset, {255, 0, 0, 255, 0, 0, 0, 255}, 2)},
        {"texCoord", 1u}};
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.materials.at(0).gloss.specular_color, (Rgb{0.5f, 0, 0}));
    EXPECT_EQ(imported.scene.materials[0].gloss.roughness, 0.5f);
    EXPECT_THAT(lines(imported.warnings), HasSubstr("its mean is used"));
}

TEST(GltfSpecularGlossiness, WrongMembersAreNamed) {
    const std::string at = std::string("/materials/0/extensions/") + kSpecularGlossiness;
    expect_faults(
        specular_asset(Json::object()),
        {{at + "/diffuseFactor", {1, 1, 1}, "diffuseFactor is not an array of four numbers"},
         {at + "/specularFactor", 1, "specularFactor is not an array of three numbers"},
         {at + "/diffuseTexture/index", 5u, "texture 5 does not exist"},
         {at, 3, "is not an object"}});
}

}  // namespace
}  // namespace opaline::tests
