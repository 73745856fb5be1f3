#include "tests/formats/gltf/asset_builder.h"
#include "tests/formats/gltf/encode_test_image.h"

namespace opaline::tests {
namespace {

using formats::Gloss;
using formats::kNone;
using formats::Rgb;
using ::testing::HasSubstr;
using ::testing::Not;

/// A triangle with texture coordinates and this material, named Shell.
AssetBuilder asset_with_material(Json material) {
    material["name"] = "Shell";
    return textured_triangle(std::move(material), 2);
}

// Red says nothing; roughness 1 and 0.2, metallic 0 and 1.
const Blob kRoughThenMetal = {7, 255, 0, 255, 9, 51, 255, 255};

/// Image 0 as texture 0, of the gloss and, where asked for, of the base colour.
AssetBuilder textured(bool with_base_color) {
    Json pbr = {{"metallicRoughnessTexture", {{"index", 0u}}}};
    if (with_base_color) {
        pbr["baseColorTexture"] = {{"index", 1u}};
    }
    AssetBuilder asset = asset_with_material({{"pbrMetallicRoughness", pbr}});
    const Blob png = encode_png(kRoughThenMetal, 2, 1);
    add_texture(asset, png, Json::object(), {{"sampler", 0u}});
    add_texture(asset, png);
    asset.json["samplers"] = Json::array({{{"wrapS", 33071u}, {"wrapT", 33648u}}});
    return asset;
}

Gloss gloss_of(const AssetBuilder& asset) {
    return must_import(asset).scene.materials.at(0).gloss;
}

TEST(GltfReflection, AbsentMembersHaveTheSpecificationsDefaults) {
    // glTF 2.0, 5.22: metallicFactor 1, roughnessFactor 1; KHR_materials_ior: 1.5;
    // KHR_materials_specular: 1 and white.
    for (const Json& material : {Json::object(), Json{{"pbrMetallicRoughness", Json::object()}},
                                 Json{{"extensions", {{"KHR_materials_ior", Json::object()}}}}}) {
        const Gloss gloss = gloss_of(asset_with_material(material));
        EXPECT_EQ(gloss.metallic, 1.0f);
        EXPECT_EQ(gloss.roughness, 1.0f);
        EXPECT_EQ(gloss.ior, 1.5f);
        EXPECT_EQ(gloss.specular, 1.0f);
        EXPECT_EQ(gloss.specular_color, (Rgb{1, 1, 1}));
        EXPECT_EQ(gloss.image, kNone);
    }
}

TEST(GltfReflection, FactorsAreRead) {
    const auto imported = must_import(asset_with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0.25}, {"roughnessFactor", 0.75}}},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 1.8}}},
           {"KHR_materials_specular",
            {{"specularFactor", 0.5}, {"specularColorFactor", {2, 1, 0.5}}}}}}}));
    const Gloss& gloss = imported.scene.materials.at(0).gloss;
    EXPECT_EQ(gloss.metallic, 0.25f);
    EXPECT_EQ(gloss.roughness, 0.75f);
    EXPECT_EQ(gloss.ior, 1.8f);
    EXPECT_EQ(gloss.specular, 0.5f);
    EXPECT_EQ(gloss.specular_color, (Rgb{2, 1, 0.5f}));
    EXPECT_FALSE(gloss.is_diffuse());
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfReflection, NeitherMetalNorSpecularIsDiffuse) {
    EXPECT_TRUE(
        gloss_of(asset_with_material(
                     {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                      {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}}))
            .is_diffuse());
    EXPECT_FALSE(gloss_of(asset_with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}))
                     .is_diffuse());
}

TEST(GltfReflection, UnlitIsDiffuseAndNamed) {
    const auto imported = must_import(
        asset_with_material({{"extensions", {{"KHR_materials_unlit", Json::object()}}}}));
    EXPECT_TRUE(imported.scene.materials.at(0).gloss.is_diffuse());
    EXPECT_THAT(lines(imported.warnings), HasSubstr("KHR_materials_unlit"));
}

// As Blender exports Principled Volume and Translucent BSDF.
TEST(GltfReflection, MetalsThatNobodyStatedAreNamedUnlessTheyHaveAMedium) {
    const auto warnings_of = [](const Json& material) {
        auto scene = must_import(asset_with_material(material)).scene;
        return lines(formats::warn_of_unstated_metals(scene));
    };
    for (const Json& pbr : {Json::object(), Json{{"baseColorFactor", {1, 0, 0, 1}}}}) {
        EXPECT_THAT(warnings_of({{"pbrMetallicRoughness", pbr}}),
                    HasSubstr("material 'Shell': the file states neither metallicFactor"));
    }
    EXPECT_THAT(warnings_of(Json::object()), HasSubstr("'Shell'"));
    // Blender leaves out a metallicFactor of 1, of metals that are meant.
    for (const Json& pbr : {Json{{"metallicFactor", 1}}, Json{{"roughnessFactor", 0.5}},
                            Json{{"metallicFactor", 0}}}) {
        EXPECT_EQ(warnings_of({{"pbrMetallicRoughness", pbr}}), "") << pbr;
    }
    EXPECT_EQ(warnings_of({{"extensions", {{"KHR_materials_unlit", Json::object()}}}}), "");
    auto scene = must_import(asset_with_material(Json::object())).scene;
    scene.materials.at(0).medium.emplace();
    EXPECT_TRUE(formats::warn_of_unstated_metals(scene).empty());
}

TEST(GltfReflection, ValuesOutOfRangeAreClampedWithAWarning) {
    const auto imported = must_import(asset_with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 2}, {"roughnessFactor", -1}}},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 0.5}}},
           {"KHR_materials_specular",
            {{"specularFactor", 3}, {"specularColorFactor", {-1, 1, 1}}}}}}}));
    const Gloss& gloss = imported.scene.materials.at(0).gloss;
    EXPECT_EQ(gloss.metallic, 1.0f);
    EXPECT_EQ(gloss.roughness, 0.0f);
    EXPECT_EQ(gloss.specular, 1.0f);
    EXPECT_EQ(gloss.specular_color, (Rgb{0, 1, 1}));
    EXPECT_EQ(gloss.ior, 1.0f);
    for (const char* name :
         {"metallicFactor", "roughnessFactor", "specularFactor", "specularColorFactor", "ior is"}) {
        EXPECT_THAT(lines(imported.warnings), HasSubstr(name));
    }
}

TEST(GltfReflection, InfiniteIndexOfRefractionIsKeptAsZero) {
    const auto imported =
        must_import(asset_with_material({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}));
    EXPECT_EQ(imported.scene.materials.at(0).gloss.ior, 0.0f);
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfReflection, WrongTypesAreErrorsThatNameTheMember) {
    expect_faults(asset_with_material({{"pbrMetallicRoughness", Json::object()}}),
                  {{"/materials/0/pbrMetallicRoughness/metallicFactor", "x",
                    "material 'Shell' > pbrMetallicRoughness: metallicFactor is not a number"},
                   {"/materials/0/pbrMetallicRoughness/roughnessFactor", "x",
                    "material 'Shell' > pbrMetallicRoughness: roughnessFactor is not a number"}});
}

TEST(GltfReflection, TextureKeepsItsCodesAndWrapModes) {
    const auto imported = must_import(textured(false));
    const Gloss& gloss = imported.scene.materials.at(0).gloss;
    ASSERT_EQ(gloss.image, 0u);
    EXPECT_EQ(imported.scene.images.at(0).rgba, kRoughThenMetal);
    EXPECT_EQ(gloss.wrap_u, formats::TextureWrap::clamp);
    EXPECT_EQ(gloss.wrap_v, formats::TextureWrap::mirror);
    EXPECT_EQ(lines(imported.warnings), "");
    EXPECT_EQ(imported.scene.materials[0].base_color_image, kNone);
}

TEST(GltfReflection, WithoutABaseColourTextureItsOwnCoordinatesAreUsed) {
    AssetBuilder asset = textured(false);
    Json& use = asset.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"];
    use["texCoord"] = 1u;
    use["extensions"]["KHR_texture_transform"] = {{"scale", {0.5, 0.5}}};
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.materials.at(0).gloss.image, 0u);
    EXPECT_EQ(imported.scene.primitives.at(0).texcoord.at(1), glm::vec2(1, 0));
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfReflection, BothTexturesShareCoordinates) {
    AssetBuilder asset = textured(true);
    const auto same = must_import(asset);
    EXPECT_EQ(same.scene.materials.at(0).base_color_image, 0u);
    EXPECT_EQ(same.scene.materials[0].gloss.image, 1u);
    EXPECT_EQ(lines(same.warnings), "");

    // Of roughness, 1 and 51/255; of metallic, 0 and 1.
    Json& use = asset.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"];
    const auto expect_mean = [&] {
        const auto imported = must_import(asset);
        const Gloss& gloss = imported.scene.materials.at(0).gloss;
        EXPECT_EQ(gloss.image, kNone);
        EXPECT_NEAR(gloss.roughness, 0.6f, 1e-6f);
        EXPECT_NEAR(gloss.metallic, 0.5f, 1e-6f);
        EXPECT_EQ(imported.scene.images.size(), 1u);
        EXPECT_THAT(lines(imported.warnings), HasSubstr("mapped otherwise than baseColorTexture"));
    };
    use["texCoord"] = 1u;
    expect_mean();
    use["texCoord"] = 0u;
    use["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 0}}};
    expect_mean();
}

TEST(GltfReflection, TextureOfADiffuseMaterialIsNotRead) {
    AssetBuilder asset = textured(false);
    asset.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 0;
    asset.json["materials"][0]["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
    EXPECT_TRUE(must_import(asset).scene.images.empty());
}

TEST(GltfReflection, TexturesOfSpecularAreNamed) {
    for (const char* name : {"specularTexture", "specularColorTexture"}) {
        const std::string warnings = lines(
            must_import(
                asset_with_material(
                    {{"extensions", {{"KHR_materials_specular", {{name, {{"index", 0u}}}}}}}}))
                .warnings);
        EXPECT_THAT(warnings, HasSubstr(std::string(name) + " is not read"));
        EXPECT_THAT(warnings, Not(HasSubstr("is not simulated")));
    }
}

TEST(GltfReflection, DamagedTextureLinksAreErrors) {
    expect_faults(
        textured(false),
        {{"/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index", 9u, "texture"},
         {"/textures/0/source", kErased, "texture 0 has no PNG or JPEG image"}});
}

}  // namespace
}  // namespace opaline::tests
