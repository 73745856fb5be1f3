#include <cmath>
#include <numbers>

#include "tests/formats/gltf/asset_builder.h"
#include "tests/formats/gltf/encode_test_image.h"

namespace opaline::tests {
namespace {

using formats::Light;
using formats::Material;
using formats::Rgb;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float kPi = std::numbers::pi_v<float>;

/// The triangle, and these lights, each at a node with these members.
AssetBuilder lit_asset(const Json& lights, const std::vector<Json>& nodes) {
    AssetBuilder asset = triangle_asset();
    asset.json["extensions"]["KHR_lights_punctual"]["lights"] = lights;
    for (const Json& members : nodes) {
        asset.json["nodes"].push_back(members);
        asset.json["scenes"][0]["nodes"].push_back(asset.json["nodes"].size() - 1);
    }
    return asset;
}

Json node_of(unsigned light, Json more = Json::object()) {
    more["extensions"]["KHR_lights_punctual"]["light"] = light;
    return more;
}

TEST(GltfLights, ALightHasTheExtensionsDefaults) {
    const auto imported =
        must_import(lit_asset({{{"type", "point"}}, {{"type", "spot"}}, {{"type", "directional"}}},
                              {node_of(0), node_of(1), node_of(2)}));
    EXPECT_EQ(lines(imported.warnings), "");
    ASSERT_EQ(imported.scene.lights.size(), 3u);
    for (const Light& light : imported.scene.lights) {
        EXPECT_EQ(light.intensity, (Rgb{1, 1, 1}));
        EXPECT_EQ(light.position, glm::vec3(0));
        EXPECT_EQ(light.range, 0.0f);
    }
    EXPECT_EQ(imported.scene.lights[0].type, Light::Type::point);
    EXPECT_EQ(imported.scene.lights[1].type, Light::Type::spot);
    EXPECT_EQ(imported.scene.lights[1].inner_cone, 0.0f);
    EXPECT_EQ(imported.scene.lights[1].outer_cone, kPi / 4);
    EXPECT_EQ(imported.scene.lights[1].direction, glm::vec3(0, 0, -1));
    EXPECT_EQ(imported.scene.lights[2].type, Light::Type::directional);
    EXPECT_EQ(imported.scene.lights[2].direction, glm::vec3(0, 0, -1));
}

TEST(GltfLights, StatedValuesAreTaken) {
    const auto imported =
        must_import(lit_asset({{{"type", "spot"},
                                {"color", {1, 0.5, 0.25}},
                                {"intensity", 20},
                                {"range", 3},
                                {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}},
                              {node_of(0)}));
    EXPECT_EQ(lines(imported.warnings), "");
    const Light& light = imported.scene.lights.at(0);
    EXPECT_EQ(light.intensity, (Rgb{20, 10, 5}));
    EXPECT_EQ(light.range, 3.0f);
    EXPECT_EQ(light.inner_cone, 0.25f);
    EXPECT_EQ(light.outer_cone, 0.5f);
}

TEST(GltfLights, EveryNodeInstanceIsALightPlacedByTheTransformsAboveIt) {
    // The parent turns by a quarter about y (-z becomes -x), moves by 2 and scales by 3.
    AssetBuilder asset =
        lit_asset({{{"type", "spot"}, {"range", 4}}}, {node_of(0, {{"translation", {0, 0, 5}}})});
    const float half = std::sqrt(0.5f);
    asset.json["nodes"].push_back({{"children", {2u}},
                                   {"translation", {2, 0, 0}},
                                   {"rotation", {0, half, 0, half}},
                                   {"scale", {3, 3, 3}}});
    asset.json["nodes"].insert(asset.json["nodes"].begin() + 2,
                               node_of(0, {{"translation", {0, 1, -1}}}));
    asset.json["scenes"][0]["nodes"].push_back(3u);
    formats::ImportOptions options;
    options.metres_per_unit = 0.5;
    const auto imported = must_import(asset, options);
    ASSERT_EQ(imported.scene.lights.size(), 2u);
    const Light &first = imported.scene.lights[0], &second = imported.scene.lights[1];
    EXPECT_EQ(first.position, glm::vec3(0, 0, 2.5f));
    EXPECT_EQ(first.range, 2.0f);  // a length of the file
    EXPECT_LT(glm::distance(second.position, 0.5f * glm::vec3(2 - 3, 3, 0)), 1e-6f);
    EXPECT_LT(glm::distance(second.direction, glm::vec3(-1, 0, 0)), 1e-6f);
    EXPECT_EQ(second.range, 2.0f);                // the extension: not scaled by the node
    EXPECT_EQ(second.intensity, (Rgb{1, 1, 1}));  // candela, whatever the unit of length is
}

TEST(GltfLights, PositionsAreRelativeToTheScenesOrigin) {
    AssetBuilder asset =
        lit_asset({{{"type", "point"}}}, {node_of(0, {{"translation", {10000.5, 0, 1}}})});
    asset.json["nodes"][0]["translation"] = {10000, 0, 0};
    const auto imported = must_import(asset);
    ASSERT_NE(imported.scene.origin.x, 0.0);
    EXPECT_EQ(imported.scene.to_world(imported.scene.lights.at(0).position),
              glm::dvec3(10000.5, 0, 1));
}

TEST(GltfLights, NamesAreTheNodesElseTheLightsAndUnique) {
    const auto imported = must_import(
        lit_asset({{{"type", "point"}, {"name", "Bulb"}}, {{"type", "point"}}},
                  {node_of(0, {{"name", "Lamp"}}), node_of(0, {{"name", "Lamp"}}), node_of(0),
                   node_of(1), node_of(0, {{"name", "Lamp 2"}}), node_of(0)}));
    std::vector<std::string> names;
    for (const Light& light : imported.scene.lights) {
        names.push_back(light.name);
    }
    EXPECT_THAT(names,
                ::testing::ElementsAre("Lamp", "Lamp 2", "Bulb", "light", "Lamp 2 2", "Bulb 2"));
}

TEST(GltfLights, ValuesOutOfTheirRangesAreClampedAndNamed) {
    const auto imported = must_import(
        lit_asset({{{"type", "point"},
                    {"name", "Bulb"},
                    {"intensity", -3},
                    {"color", {2, -1, 0.5}},
                    {"range", 0}},
                   {{"type", "point"}, {"intensity", 1e300}},
                   {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.6}, {"outerConeAngle", 0.4}}}},
                   {{"type", "spot"}, {"spot", {{"innerConeAngle", -1}, {"outerConeAngle", 3}}}}},
                  {node_of(0), node_of(1), node_of(2), node_of(3)}));
    const std::string warnings = lines(imported.warnings);
    for (const char* remark :
         {"light 'Bulb': intensity is out of its range", "light 'Bulb': color is outside [0, 1]",
          "light 'Bulb': range is not above 0", "light 1: intensity is out of its range",
          "light 2: innerConeAngle is not below outerConeAngle",
          "light 3: innerConeAngle is out of its range",
          "light 3: outerConeAngle is out of its range"}) {
        EXPECT_THAT(warnings, HasSubstr(remark));
    }
    const auto& lights = imported.scene.lights;
    EXPECT_EQ(lights.at(0).intensity, (Rgb{0, 0, 0}));
    EXPECT_EQ(lights.at(1).intensity, (Rgb{1e12f, 1e12f, 1e12f}));
    EXPECT_LT(lights.at(2).inner_cone, lights.at(2).outer_cone);
    EXPECT_EQ(lights.at(2).outer_cone, 0.4f);
    EXPECT_EQ(lights.at(3).inner_cone, 0.0f);
    EXPECT_EQ(lights.at(3).outer_cone, kPi / 2);
}

TEST(GltfLights, WrongTypesAndLinksAreErrors) {
    const std::string lights = "/extensions/KHR_lights_punctual/lights", light = lights + "/0";
    expect_faults(lit_asset({{{"type", "point"}}}, {node_of(0)}),
                  {{light + "/type", "area",
                    "light 0: its type is 'area' (make it 'point', 'spot' or 'directional')"},
                   {light, {{"name", "x"}}, "light 'x': its type is missing"},
                   {light + "/intensity", "1", "light 0: intensity is not a number"},
                   {light + "/color", {1, 1}, "light 0: color is not an array of three numbers"},
                   {light + "/spot", 1, "light 0: spot is not an object"},
                   {lights, 3, "lights is not an array of objects"},
                   {"/nodes/1/extensions/KHR_lights_punctual/light", 1,
                    "node 1: light 1 does not exist: there are 1"},
                   {"/nodes/1/extensions/KHR_lights_punctual/light", -1,
                    "node 1: KHR_lights_punctual: light is not a small whole number"},
                   {"/nodes/1/translation", {1e300, 0, 0}, "node 1: its light is too far away"}});
    expect_faults(lit_asset({{{"type", "spot"}}}, {node_of(0)}),
                  {{"/nodes/1/scale", {1, 1, 0}, "node 1: its light has no direction"}});
}

TEST(GltfLights, TooManyAreRefused) {
    const auto result =
        import_asset(lit_asset({{{"type", "point"}}}, std::vector<Json>(4097, node_of(0))));
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, formats::ErrorKind::resource);
    EXPECT_THAT(errors_of(result), HasSubstr("the scene has 4097 lights, the limit is 4096"));
}

/// The triangle with these members of its material, and coordinates.
AssetBuilder glowing_asset(Json material) {
    AssetBuilder asset = textured_triangle(std::move(material));
    add_texture(asset, encode_png({255, 0, 0, 255, 0, 0, 255, 255}, 2, 1));
    return asset;
}

TEST(GltfEmission, FactorTimesStrengthIsTheRadiance) {
    const auto imported = must_import(glowing_asset(
        {{"emissiveFactor", {1, 0.5, 0.25}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 100}}}}}}));
    EXPECT_EQ(lines(imported.warnings), "");
    EXPECT_EQ(imported.scene.materials.at(0).emission, (Rgb{100, 50, 25}));
    EXPECT_EQ(imported.scene.materials[0].emission_image, formats::kNone);
}

TEST(GltfEmission, TheTextureMultipliesIt) {
    const auto imported = must_import(glowing_asset(
        {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0u}, {"texCoord", 1u}}}}));
    EXPECT_EQ(lines(imported.warnings), "");
    const Material& material = imported.scene.materials.at(0);
    ASSERT_EQ(material.emission_image, 0u);
    EXPECT_EQ(imported.scene.images.at(0).width, 2u);
    EXPECT_EQ(material.base_color_texcoord, 1u);
}

TEST(GltfEmission, OfATextureMappedOtherwiseTheMeanCounts) {
    const auto imported = must_import(
        glowing_asset({{"emissiveFactor", {1, 1, 1}},
                       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0u}}}}},
                       {"emissiveTexture", {{"index", 0u}, {"texCoord", 1u}}}}));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("emissiveTexture is mapped otherwise"));
    EXPECT_EQ(imported.scene.materials.at(0).emission_image, formats::kNone);
    EXPECT_EQ(imported.scene.materials[0].emission, (Rgb{0.5f, 0, 0.5f}));  // half red, half blue
}

TEST(GltfEmission, ATextureWithoutAFactorIsNotLoaded) {
    const auto imported = must_import(glowing_asset({{"emissiveTexture", {{"index", 0u}}}}));
    EXPECT_TRUE(imported.scene.images.empty());
    EXPECT_EQ(imported.scene.materials.at(0).emission, (Rgb{0, 0, 0}));
}

TEST(GltfEmission, BadValuesAreClampedOrErrors) {
    const auto imported = must_import(glowing_asset(
        {{"emissiveFactor", {2, -1, 1}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", -5}}}}}}));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("emissiveFactor is outside [0, 1]"));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("emissiveStrength is out of its range"));
    EXPECT_EQ(imported.scene.materials.at(0).emission, (Rgb{0, 0, 0}));
    const char* const strength =
        "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
    expect_faults(glowing_asset({{"emissiveFactor", {1, 1, 1}}}),
                  {{"/materials/0/emissiveFactor",
                    {1, 1},
                    "material 0: emissiveFactor is not an array of three numbers"},
                   {strength, "x", "emissiveStrength is not a number"},
                   {"/materials/0/emissiveTexture/index", 7u, "texture 7 does not exist"}});
}

TEST(GltfCoverage, AlphaIsThatOfFactorVerticesAndCutoff) {
    AssetBuilder asset =
        glowing_asset({{"alphaMode", "MASK"},
                       {"alphaCutoff", 0.25},
                       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.75}}}}});
    asset.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        asset.add<float>({1, 1, 1, 0, 1, 1, 1, 0.5, 1, 1, 1, 1}, "VEC4");
    const auto imported = must_import(asset);
    const Material& material = imported.scene.materials.at(0);
    EXPECT_EQ(material.alpha_mode, Material::AlphaMode::mask);
    EXPECT_EQ(material.alpha, 0.75f);
    EXPECT_EQ(material.alpha_cutoff, 0.25f);
    EXPECT_THAT(imported.scene.primitives.at(0).alpha, ::testing::ElementsAre(0, 0.5f, 1));

    asset.json["materials"][0].erase("alphaCutoff");
    EXPECT_EQ(must_import(asset).scene.materials.at(0).alpha_cutoff, 0.5f);
    asset.json["materials"][0]["alphaMode"] = "BLEND";
    EXPECT_EQ(must_import(asset).scene.materials.at(0).alpha_mode, Material::AlphaMode::blend);
    asset.json["materials"][0]["alphaMode"] = "OPAQUE";
    EXPECT_THAT(must_import(asset).scene.primitives.at(0).alpha, IsEmpty());
}

TEST(GltfCoverage, OfMediaItIsNamedAndOpaque) {
    const auto imported = must_import(
        glowing_asset({{"alphaMode", "MASK"},
                       {"extensions",
                        {{"KHR_materials_volume",
                          {{"thicknessFactor", 1},
                           {"attenuationDistance", 1},
                           {"attenuationColor", {0.9, 0.5, 0.25}}}},
                         {"KHR_materials_scatter", {{"scatterStrengthFactor", 1}}},
                         {"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}));
    ASSERT_TRUE(imported.scene.materials.at(0).medium.has_value());
    EXPECT_EQ(imported.scene.materials[0].alpha_mode, Material::AlphaMode::opaque);
    EXPECT_THAT(lines(imported.warnings),
                HasSubstr("alphaMode 'MASK' is not simulated of a medium"));
}

}  // namespace
}  // namespace opaline::tests
