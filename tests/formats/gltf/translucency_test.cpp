#include <cmath>

#include "formats/gltf/map_medium.h"
#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using formats::Medium;
using formats::PhaseFunction;
using formats::gltf::single_scattering_albedo;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The triangle in a material with these extensions and a white, dielectric surface.
AssetBuilder asset_with(Json extensions) {
    AssetBuilder asset = triangle_asset();
    asset.json["meshes"][0]["primitives"][0]["material"] = 0u;
    asset.json["materials"] =
        Json::array({{{"name", "Wax"},
                      {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.25}}},
                      {"extensions", std::move(extensions)}}});
    return asset;
}

Json scattering_extensions() {
    return {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
            {"KHR_materials_volume",
             {{"thicknessFactor", 1},
              {"attenuationDistance", 0.02},
              {"attenuationColor", {0.9, 0.5, 0.25}}}},
            {"KHR_materials_scatter",
             {{"scatterStrengthFactor", 1},
              {"multiscatterColorFactor", {0.8, 0.5, 0}},
              {"scatterAnisotropy", 0.5}}}};
}

struct Mapped {
    std::optional<Medium> medium;
    std::string warnings;
};

Mapped mapped(const AssetBuilder& asset, const formats::ImportOptions& options = {}) {
    const auto imported = must_import(asset, options);
    return imported.scene.materials.empty()
               ? Mapped{}
               : Mapped{imported.scene.materials[0].medium, lines(imported.warnings)};
}

TEST(GltfTranslucency, VolumeAndScatterBecomeAMedium) {
    const Mapped wax = mapped(asset_with(scattering_extensions()));
    ASSERT_TRUE(wax.medium.has_value()) << wax.warnings;
    EXPECT_EQ(wax.warnings, "");
    const double kept[3] = {0.9, 0.5, 0.25}, color[3] = {0.8, 0.5, 0};
    const auto band = [](formats::Rgb c, int i) { return i == 0 ? c.r : i == 1 ? c.g : c.b; };
    for (int i = 0; i < 3; ++i) {
        const double sigma_t = -std::log(kept[i]) / 0.02;
        const double sigma_s = sigma_t * single_scattering_albedo(color[i], 0.5);
        EXPECT_NEAR(band(wax.medium->sigma_s, i), sigma_s, 1e-6 * sigma_t) << i;
        EXPECT_NEAR(band(wax.medium->sigma_a, i), sigma_t - sigma_s, 1e-6 * sigma_t) << i;
    }
    EXPECT_EQ(wax.medium->phase.type, PhaseFunction::Type::henyey_greenstein);
    EXPECT_EQ(wax.medium->phase.g, 0.5f);
    EXPECT_EQ(wax.medium->eta, 1.5f);  // glTF's, not that of media files
    EXPECT_EQ(wax.medium->roughness, 0.25f);
}

TEST(GltfTranslucency, LightFallsToAttenuationColourOverAttenuationDistance) {
    // Beer-Lambert: exp(-sigma_t d) = c, whatever the share that scatters.
    const Medium medium = *mapped(asset_with(scattering_extensions())).medium;
    EXPECT_NEAR(std::exp(-0.02 * (medium.sigma_s.g + medium.sigma_a.g)), 0.5, 1e-6);
}

TEST(GltfTranslucency, AttenuationDistanceIsInWorldUnitsNotScaledByNodes) {
    const Medium metres = *mapped(asset_with(scattering_extensions())).medium;
    const Medium centimetres = *mapped(asset_with(scattering_extensions()), {0.01}).medium;
    EXPECT_FLOAT_EQ(centimetres.sigma_s.r, 100 * metres.sigma_s.r);
    EXPECT_FLOAT_EQ(centimetres.sigma_a.r, 100 * metres.sigma_a.r);
    AssetBuilder scaled = asset_with(scattering_extensions());
    scaled.json["nodes"][0]["scale"] = {7, 7, 7};
    EXPECT_EQ(mapped(scaled).medium->sigma_s, metres.sigma_s);
}

TEST(GltfTranslucency, StrengthScalesTheColour) {
    Json weak = scattering_extensions(), dark = scattering_extensions();
    weak["KHR_materials_scatter"]["scatterStrengthFactor"] = 0.5;
    dark["KHR_materials_scatter"]["multiscatterColorFactor"] = {0.4, 0.25, 0};
    EXPECT_EQ(mapped(asset_with(weak)).medium->sigma_s, mapped(asset_with(dark)).medium->sigma_s);
}

TEST(GltfTranslucency, PredecessorHasNoAnisotropyInItsAlbedo) {
    Json old = scattering_extensions();
    old.erase("KHR_materials_scatter");
    old["KHR_materials_volume_scatter"] = {{"multiscatterColor", {0.8, 0.5, 0}},
                                           {"scatterAnisotropy", 0.5}};
    const Medium medium = *mapped(asset_with(old)).medium;
    EXPECT_NEAR(medium.sigma_s.r / (medium.sigma_s.r + medium.sigma_a.r),
                single_scattering_albedo(0.8, 0), 1e-6);
    EXPECT_EQ(medium.phase.g, 0.5f);
    // Both of its spellings, and light that enters by diffuse transmission.
    old["KHR_materials_volume_scatter"] = {{"multiscatterColorFactor", {0.8, 0.5, 0}}};
    old.erase("KHR_materials_transmission");
    old["KHR_materials_diffuse_transmission"] = {{"diffuseTransmissionFactor", 1}};
    const Mapped diffuse = mapped(asset_with(old));
    ASSERT_TRUE(diffuse.medium.has_value()) << diffuse.warnings;
    EXPECT_EQ(diffuse.medium->sigma_s, medium.sigma_s);
    EXPECT_EQ(diffuse.medium->phase.type, PhaseFunction::Type::isotropic);
    EXPECT_THAT(diffuse.warnings, HasSubstr("diffuse lobe"));
}

TEST(GltfTranslucency, AbsentStrengthSwitchesScatteringOffAndWarns) {
    Json trap = scattering_extensions();
    trap["KHR_materials_scatter"].erase("scatterStrengthFactor");
    const Mapped absent = mapped(asset_with(trap));
    EXPECT_FALSE(absent.medium.has_value());
    EXPECT_THAT(absent.warnings,
                AllOf(HasSubstr("scatterStrengthFactor is absent and 0 by default"),
                      HasSubstr("material 'Wax'")));
    trap["KHR_materials_scatter"]["scatterStrengthFactor"] = 0;
    EXPECT_THAT(mapped(asset_with(trap)).warnings, HasSubstr("scatterStrengthFactor is 0"));
}

TEST(GltfTranslucency, WhatDescribesNoScatteringMediumIsBakedDiffuseWithAWarning) {
    const auto refused = [](const char* pointer, const Json& value) {
        Json extensions = scattering_extensions();
        extensions[Json::json_pointer(pointer)] = value;
        const Mapped result = mapped(asset_with(extensions));
        EXPECT_FALSE(result.medium.has_value()) << pointer << value;
        EXPECT_THAT(result.warnings, HasSubstr("baked diffuse")) << pointer << value;
        return result.warnings;
    };
    EXPECT_THAT(refused("/KHR_materials_volume/attenuationDistance", 0), HasSubstr("not above 0"));
    EXPECT_THAT(refused("/KHR_materials_volume/attenuationDistance", 1e-30), HasSubstr("extreme"));
    EXPECT_THAT(refused("/KHR_materials_volume/attenuationDistance", 1e30), HasSubstr("extreme"));
    EXPECT_THAT(refused("/KHR_materials_volume/attenuationColor", {1, 1, 1}), HasSubstr("white"));
    EXPECT_THAT(refused("/KHR_materials_volume", Json::object({{"thicknessFactor", 1}})),
                HasSubstr("attenuationDistance is absent"));
    EXPECT_THAT(refused("/KHR_materials_scatter/multiscatterColorFactor", {0, 0, 0}),
                HasSubstr("black"));
    EXPECT_THAT(refused("/KHR_materials_transmission/transmissionFactor", 0),
                HasSubstr("no light enters"));
    Json extensions = scattering_extensions();
    extensions.erase("KHR_materials_volume");
    EXPECT_FALSE(mapped(asset_with(extensions)).medium.has_value());
}

void expect_near(formats::Rgb found, glm::dvec3 expected) {
    EXPECT_NEAR(found.r, expected.x, 1e-6);
    EXPECT_NEAR(found.g, expected.y, 1e-6);
    EXPECT_NEAR(found.b, expected.z, 1e-6);
}

TEST(GltfTranslucency, DiffuseTransmissionIsAThinWalledSurfaceOfTwoSides) {
    AssetBuilder leaf = asset_with({{"KHR_materials_diffuse_transmission",
                                     {{"diffuseTransmissionFactor", 0.25},
                                      {"diffuseTransmissionColorFactor", {0.4, 1, 0.8}}}}});
    leaf.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.2, 0, 1};
    const auto imported = must_import(leaf);
    const formats::Material& material = imported.scene.materials[0];
    EXPECT_EQ(lines(imported.warnings), "");
    EXPECT_FALSE(material.medium);
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
TEST(GltfTranslucency, ScatteringWithoutThicknessIsAThinWalledSurface) {
    Json extensions = scattering_extensions();
    extensions["KHR_materials_volume"]["thicknessFactor"] = 0;
    AssetBuilder paper = asset_with(extensions);
    paper.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0.5, 1, 1};
    const auto imported = must_import(paper);
    const formats::Material& material = imported.scene.materials[0];
    EXPECT_EQ(lines(imported.warnings), "");
    EXPECT_FALSE(material.medium);
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
TEST(GltfTranslucency, TransmissionWithoutVolumeIsThinGlassThatLightPassesStraight) {
    AssetBuilder pane = asset_with({{"KHR_materials_transmission", {{"transmissionFactor", 1}}}});
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

TEST(GltfTranslucency, GlassIsAMediumThatAbsorbsAndDoesNotScatter) {
    Json glass = scattering_extensions();
    glass.erase("KHR_materials_scatter");
    glass["KHR_materials_volume"] = {
        {"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.25, 1, 0}}};
    const Mapped tinted = mapped(asset_with(glass));
    ASSERT_TRUE(tinted.medium.has_value()) << tinted.warnings;
    EXPECT_EQ(tinted.medium->sigma_s, formats::Rgb{});
    EXPECT_NEAR(tinted.medium->sigma_a.r, std::log(4.0) / 0.5, 1e-5) << "a quarter in half a metre";
    EXPECT_LT(tinted.medium->sigma_a.g, 1e-9f);
    EXPECT_GT(tinted.medium->sigma_a.b, 100);
    glass["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    const Mapped clear = mapped(asset_with(glass));
    ASSERT_TRUE(clear.medium.has_value()) << "the distance is infinite by default";
    EXPECT_GT(clear.medium->sigma_a.r, 0) << "some number, that nobody sees";
    EXPECT_LT(clear.medium->sigma_a.r, 1e-9f);
    // Without an inside, or where no light enters, there is no medium.
    glass["KHR_materials_volume"] = {{"thicknessFactor", 0}};
    EXPECT_FALSE(mapped(asset_with(glass)).medium.has_value());
    glass["KHR_materials_volume"] = {{"thicknessFactor", 1}, {"attenuationDistance", 0}};
    EXPECT_FALSE(mapped(asset_with(glass)).medium.has_value());
    glass["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    glass.erase("KHR_materials_transmission");
    const Mapped closed = mapped(asset_with(glass));
    EXPECT_FALSE(closed.medium.has_value());
    EXPECT_THAT(closed.warnings, HasSubstr("KHR_materials_volume is not simulated"));
}

TEST(GltfTranslucency, IndexOfRefractionComesFromIorAndSpecular) {
    Json extensions = scattering_extensions();
    const auto eta = [&] { return mapped(asset_with(extensions)).medium->eta; };
    extensions["KHR_materials_ior"] = {{"ior", 1.3}};
    EXPECT_FLOAT_EQ(eta(), 1.3f);
    extensions["KHR_materials_specular"] = Json::object({{"specularFactor", 1}});
    EXPECT_FLOAT_EQ(eta(), 1.3f);
    // A quarter of the reflectance: half its root, r = (eta - 1)/(eta + 1).
    extensions["KHR_materials_specular"]["specularFactor"] = 0.25;
    const double found = static_cast<double>(eta());
    EXPECT_NEAR((found - 1) / (found + 1), 0.5 * 0.3 / 2.3, 1e-6);
    extensions["KHR_materials_specular"]["specularFactor"] = 0;
    EXPECT_EQ(eta(), 1.0f);
    extensions["KHR_materials_specular"] = {{"specularColorFactor", {1000, 1000, 1000}}};
    EXPECT_EQ(eta(), 3.0f);
    extensions.erase("KHR_materials_specular");
    extensions["KHR_materials_ior"]["ior"] = 0;
    EXPECT_EQ(eta(), 1.5f);
    EXPECT_THAT(mapped(asset_with(extensions)).warnings, HasSubstr("ior 0"));
    extensions["KHR_materials_ior"]["ior"] = 9;
    EXPECT_EQ(eta(), 3.0f);
}

TEST(GltfTranslucency, EveryTextureOnAFactorIsNamed) {
    Json extensions = scattering_extensions();
    extensions["KHR_materials_transmission"]["transmissionTexture"] = {{"index", 0}};
    extensions["KHR_materials_volume"]["thicknessTexture"] = {{"index", 0}};
    extensions["KHR_materials_specular"]["specularTexture"] = {{"index", 0}};
    extensions["KHR_materials_specular"]["specularColorTexture"] = {{"index", 0}};
    const Mapped result = mapped(asset_with(extensions));
    ASSERT_TRUE(result.medium.has_value());
    for (const char* name :
         {"transmissionTexture", "thicknessTexture", "specularTexture", "specularColorTexture"}) {
        EXPECT_THAT(result.warnings,
                    HasSubstr(std::string(name) + " is not simulated: the factor is used alone"));
    }
    EXPECT_THAT(result.warnings, Not(HasSubstr("KHR_")));
}

TEST(GltfTranslucency, WhatAMediumCannotHoldIsNamed) {
    Json extensions = scattering_extensions();
    extensions["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
    extensions["KHR_materials_specular"] = {{"specularColorFactor", {1, 0.5, 0}}};
    extensions["KHR_materials_diffuse_transmission"] = {
        {"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {1, 0, 0}}};
    extensions["KHR_materials_scatter"]["scatterAnisotropy"] = 1;
    AssetBuilder asset = asset_with(extensions);
    asset.json["materials"][0]["pbrMetallicRoughness"].erase("metallicFactor");
    const Mapped result = mapped(asset);
    ASSERT_TRUE(result.medium.has_value());
    EXPECT_EQ(result.medium->phase.g, 0.99f);
    for (const char* text :
         {"transmissionFactor below 1", "coloured specularColorFactor", "scatterAnisotropy is out",
          "diffuseTransmissionFactor contradicts", "diffuseTransmissionColorFactor",
          "metallicFactor above 0 is not simulated: the surface is baked as a dielectric"}) {
        EXPECT_THAT(result.warnings, HasSubstr(text));
    }
}

TEST(GltfTranslucency, WrongTypesAreErrorsThatNameTheMember) {
    const std::string extensions = "/materials/0/extensions/KHR_materials_";
    for (const std::string member :
         {"volume/attenuationDistance", "volume/attenuationColor", "volume/thicknessFactor",
          "scatter/scatterStrengthFactor", "scatter/multiscatterColorFactor",
          "scatter/scatterAnisotropy", "transmission/transmissionFactor", "ior/ior",
          "specular/specularColorFactor"}) {
        const std::string said = member.substr(member.find('/') + 1) + " is not";
        expect_faults(asset_with(scattering_extensions()),
                      {{extensions + member, "x", "material 'Wax' > KHR_materials"},
                       {extensions + member, "x", said.c_str()}});
    }
    expect_faults(asset_with(scattering_extensions()),
                  {{extensions + "volume", 5, "KHR_materials_volume is not an object"}});
}

TEST(GltfTranslucency, FilesMayRequireWhatIsMapped) {
    AssetBuilder asset = asset_with(scattering_extensions());
    asset.json["extensionsRequired"] = {
        "KHR_materials_volume",       "KHR_materials_scatter", "KHR_materials_volume_scatter",
        "KHR_materials_transmission", "KHR_materials_ior",     "KHR_materials_diffuse_transmission",
        "KHR_materials_specular",     "OPALINE_media"};
    EXPECT_TRUE(mapped(asset).medium.has_value());
}

TEST(GltfTranslucency, RootExtensionIsPassedOnAsItStands) {
    AssetBuilder asset = triangle_asset();
    EXPECT_EQ(must_import(asset).media, "");
    const Json media = {{"materials", {{"*", {{"preset", "marble"}}}}}};
    asset.json["extensions"]["OPALINE_media"] = media;
    EXPECT_EQ(Json::parse(must_import(asset).media), media);
}

TEST(GltfTranslucency, ReplacedValuesGiveASoundMediumOrAMessage) {
    const Json values = {0,    1,    -1,  0.5,  1e-300,        1e300,          1e-30,
                         1e30, "x",  0.0, true, Json::array(), Json::object(), nullptr,
                         3,    1e-9, 1e9};
    Json whole = scattering_extensions();
    whole["KHR_materials_ior"] = {{"ior", 1.4}};
    whole["KHR_materials_specular"] = {{"specularFactor", 0.5}, {"specularColorFactor", {1, 1, 2}}};
    const Json flat = whole.flatten();
    for (const auto& [path, old] : flat.items()) {
        for (const Json& value : values) {
            Json damaged = whole;
            damaged[Json::json_pointer(path)] = value;
            const auto result = import_asset(asset_with(damaged));
            if (!result || !result->scene.materials.at(0).medium) continue;
            const Medium& medium = *result->scene.materials[0].medium;
            float sum = 0;
            for (const formats::Rgb sigma : {medium.sigma_s, medium.sigma_a}) {
                for (const float band : {sigma.r, sigma.g, sigma.b}) {
                    ASSERT_TRUE(std::isfinite(band) && band >= 0) << path << " = " << value;
                    sum += band;
                }
            }
            ASSERT_GT(sum, 0) << path << " = " << value;
            ASSERT_TRUE(medium.eta >= 1 && medium.eta <= 3) << path << " = " << value;
            ASSERT_LE(std::abs(medium.phase.g), 0.99f) << path << " = " << value;
            ASSERT_TRUE(medium.roughness >= 0 && medium.roughness <= 1) << path << " = " << value;
        }
    }
}

}  // namespace
}  // namespace opaline::tests
