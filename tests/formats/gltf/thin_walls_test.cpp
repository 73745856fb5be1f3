// Materials of thin-walled surfaces: leaves, paper, panes.
#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

void expect_near(formats::Rgb found, glm::dvec3 expected) {
    EXPECT_NEAR(found.r, expected.x, 1e-6);
    EXPECT_NEAR(found.g, expected.y, 1e-6);
    EXPECT_NEAR(found.b, expected.z, 1e-6);
}

// The first material: a surface of two sides and no body, without a warning.
formats::Material must_be_thin(const AssetBuilder& asset) {
    const auto imported = must_import(asset);
    EXPECT_EQ(lines(imported.warnings), "");
    EXPECT_FALSE(imported.scene.materials[0].medium);
    return imported.scene.materials[0];
}

TEST(GltfThinWalls, DiffuseTransmissionIsAThinWalledSurfaceOfTwoSides) {
    AssetBuilder leaf =
        asset_with_extensions({{"KHR_materials_diffuse_transmission",
                                {{"diffuseTransmissionFactor", 0.25},
                                 {"diffuseTransmissionColorFactor", {0.4, 1, 0.8}}}}});
    leaf.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.2, 0, 1};
    const formats::Material material = must_be_thin(leaf);
    ASSERT_TRUE(material.sheet);
    EXPECT_TRUE(material.double_sided);
    // What is reflected and transmitted, whichever of the two is the larger.
    expect_near(material.base_color * material.sheet->reflect, {0.375, 0.15, 0});
    expect_near(material.base_color * material.sheet->transmit, {0.1, 0.25, 0.2});
    for (const float share : {material.sheet->reflect.r, material.sheet->reflect.b,
                              material.sheet->transmit.g, material.sheet->transmit.b}) {
        EXPECT_TRUE(share >= 0 && share <= 1);
    }
    EXPECT_EQ(material.sheet->opaque_color, (formats::Rgb{0.5f, 0.2f, 0}));
    EXPECT_FALSE(material.sheet->opaque_double_sided);
    // A clear lobe in place of half of the diffuse part; a metal that the colours would tint.
    AssetBuilder clear = leaf;
    clear.json["materials"][0]["extensions"]["KHR_materials_transmission"] = {
        {"transmissionFactor", 0.5}};
    clear.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1;
    const auto half = must_import(clear);
    EXPECT_THAT(lines(half.warnings), HasSubstr("metallicFactor"));
    // What its roughness of a quarter spreads of the clear lobe, 1 - (3/4)^2, in the base colour.
    expect_near(half.scene.materials[0].base_color * half.scene.materials[0].sheet->transmit,
                {0.05 + 0.21875 * 0.5, 0.125 + 0.21875 * 0.2, 0.1});
    EXPECT_EQ(half.scene.materials[0].sheet->clear, 0) << "a metal";
    // A volume makes it a body, which is as it was.
    leaf.json["materials"][0]["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    EXPECT_FALSE(must_import(leaf).scene.materials[0].sheet);
    // Out of range, and of nothing.
    leaf.json["materials"][0]["extensions"].erase("KHR_materials_volume");
    Json& thin = leaf.json["materials"][0]["extensions"]["KHR_materials_diffuse_transmission"];
    thin["diffuseTransmissionFactor"] = 7;
    const auto clamped = must_import(leaf);
    EXPECT_THAT(lines(clamped.warnings), HasSubstr("clamped"));
    EXPECT_EQ(clamped.scene.materials[0].sheet->reflect, formats::Rgb{});
    thin["diffuseTransmissionFactor"] = 0;
    EXPECT_FALSE(must_import(leaf).scene.materials[0].sheet);
}

// Share (1 + g) / 2 goes on forward.
TEST(GltfThinWalls, ScatteringWithoutThicknessIsAThinWalledSurface) {
    Json extensions = scattering_extensions();
    extensions["KHR_materials_volume"]["thicknessFactor"] = 0;
    AssetBuilder paper = asset_with_extensions(extensions);
    paper.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0.5, 1, 1};
    const formats::Material material = must_be_thin(paper);
    ASSERT_TRUE(material.sheet);
    expect_near(material.base_color * material.sheet->reflect, {0.25 * 0.8, 0.25 * 0.25, 0});
    expect_near(material.base_color * material.sheet->transmit, {0.75 * 0.8, 0.75 * 0.25, 0});
    // Half of it does not enter; half of the rest passes unscattered.
    paper.json["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] =
        0.5;
    paper.json["materials"][0]["extensions"]["KHR_materials_scatter"]["scatterStrengthFactor"] =
        0.5;
    paper.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0;
    const formats::Material mixed = must_import(paper).scene.materials[0];
    EXPECT_NEAR(mixed.sheet->clear, 0.25f * formats::luminance({1, 0.5f, 1}), 1e-6);
    const formats::Rgb through = mixed.base_color * mixed.sheet->transmit,
                       back = mixed.base_color * mixed.sheet->reflect;
    EXPECT_NEAR(through.r / back.r, 0.75 * 0.2 / (0.5 + 0.25 * 0.2), 1e-5);
    EXPECT_NEAR(through.g / back.g, 0.75 * 0.0625 / (0.25 + 0.25 * 0.0625), 1e-5);
    EXPECT_GT(back.r, 0.55) << "of the light that does not pass";
}

// Windows, corneas, bottles of most exporters. Along the normal R = 0.04 of a face, so that
// 2 R / (1 + R) of the light is mirrored and nothing is lost.
TEST(GltfThinWalls, TransmissionWithoutVolumeIsThinGlassThatLightPassesStraight) {
    AssetBuilder pane =
        asset_with_extensions({{"KHR_materials_transmission", {{"transmissionFactor", 1}}}});
    Json& surface = pane.json["materials"][0]["pbrMetallicRoughness"];
    surface["roughnessFactor"] = 0;
    const auto imported = must_import(pane);
    const formats::Material& clear = imported.scene.materials[0];
    EXPECT_THAT(lines(imported.warnings), Not(HasSubstr("not simulated")));
    EXPECT_FALSE(clear.medium);
    ASSERT_TRUE(clear.sheet);
    EXPECT_TRUE(clear.double_sided);
    EXPECT_EQ(clear.sheet->clear, 1);
    EXPECT_EQ(clear.sheet->eta, 1.5f);
    EXPECT_EQ(clear.base_color, formats::Rgb{}) << "it scatters nothing";
    EXPECT_EQ(clear.gloss.ior, 0) << "what does not pass is mirrored";
    // Frosted: what enters leaves diffusely on the other side.
    surface["roughnessFactor"] = 1;
    const formats::Material frosted = must_import(pane).scene.materials[0];
    EXPECT_EQ(frosted.sheet->clear, 0);
    expect_near(frosted.base_color * frosted.sheet->transmit, {1, 1, 1});
    expect_near(frosted.base_color * frosted.sheet->reflect, {0, 0, 0});
    EXPECT_NEAR(frosted.gloss.ior, 1.5f, 1e-3);
    // A tint dims; half of the surface is paint, which is met more often than the glass.
    surface["roughnessFactor"] = 0;
    surface["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
    EXPECT_EQ(must_import(pane).scene.materials[0].sheet->clear, 0.5f);
    pane.json["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] =
        0.5;
    const formats::Material painted = must_import(pane).scene.materials[0];
    EXPECT_EQ(painted.sheet->clear, 0.25f);
    const float paint = (painted.base_color * painted.sheet->reflect).g;
    EXPECT_TRUE(paint > 0.25f && paint < 0.25f / (1 - 0.25f)) << paint;
    surface["baseColorFactor"] = {0.2, 0.5, 0.2, 1};
    EXPECT_THAT(lines(must_import(pane).warnings), HasSubstr("luminance"));
}

}  // namespace
}  // namespace opaline::tests
