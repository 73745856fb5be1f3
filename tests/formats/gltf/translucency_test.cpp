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
    const Mapped wax = mapped(asset_with_extensions(scattering_extensions()));
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

TEST(GltfTranslucency, AttenuationDistanceIsInWorldUnitsNotScaledByNodes) {
    const Medium metres = *mapped(asset_with_extensions(scattering_extensions())).medium;
    const Medium centimetres =
        *mapped(asset_with_extensions(scattering_extensions()), {0.01}).medium;
    EXPECT_FLOAT_EQ(centimetres.sigma_s.r, 100 * metres.sigma_s.r);
    EXPECT_FLOAT_EQ(centimetres.sigma_a.r, 100 * metres.sigma_a.r);
    AssetBuilder scaled = asset_with_extensions(scattering_extensions());
    scaled.json["nodes"][0]["scale"] = {7, 7, 7};
    EXPECT_EQ(mapped(scaled).medium->sigma_s, metres.sigma_s);
}

TEST(GltfTranslucency, StrengthScalesTheColour) {
    Json weak = scattering_extensions(), dark = scattering_extensions();
    weak["KHR_materials_scatter"]["scatterStrengthFactor"] = 0.5;
    dark["KHR_materials_scatter"]["multiscatterColorFactor"] = {0.4, 0.25, 0};
    EXPECT_EQ(mapped(asset_with_extensions(weak)).medium->sigma_s,
              mapped(asset_with_extensions(dark)).medium->sigma_s);
}

TEST(GltfTranslucency, PredecessorHasNoAnisotropyInItsAlbedo) {
    Json old = scattering_extensions();
    old.erase("KHR_materials_scatter");
    old["KHR_materials_volume_scatter"] = {{"multiscatterColor", {0.8, 0.5, 0}},
                                           {"scatterAnisotropy", 0.5}};
    const Medium medium = *mapped(asset_with_extensions(old)).medium;
    EXPECT_NEAR(medium.sigma_s.r / (medium.sigma_s.r + medium.sigma_a.r),
                single_scattering_albedo(0.8, 0), 1e-6);
    EXPECT_EQ(medium.phase.g, 0.5f);
    // Both of its spellings, and light that enters by diffuse transmission.
    old["KHR_materials_volume_scatter"] = {{"multiscatterColorFactor", {0.8, 0.5, 0}}};
    old.erase("KHR_materials_transmission");
    old["KHR_materials_diffuse_transmission"] = {{"diffuseTransmissionFactor", 1}};
    const Mapped diffuse = mapped(asset_with_extensions(old));
    ASSERT_TRUE(diffuse.medium.has_value()) << diffuse.warnings;
    EXPECT_EQ(diffuse.medium->sigma_s, medium.sigma_s);
    EXPECT_EQ(diffuse.medium->phase.type, PhaseFunction::Type::isotropic);
    EXPECT_THAT(diffuse.warnings, HasSubstr("diffuse lobe"));
}

TEST(GltfTranslucency, AbsentStrengthSwitchesScatteringOffAndWarns) {
    Json trap = scattering_extensions();
    trap["KHR_materials_scatter"].erase("scatterStrengthFactor");
    const Mapped absent = mapped(asset_with_extensions(trap));
    EXPECT_FALSE(absent.medium.has_value());
    EXPECT_THAT(absent.warnings,
                AllOf(HasSubstr("scatterStrengthFactor is absent and 0 by default"),
                      HasSubstr("material 'Wax'")));
    trap["KHR_materials_scatter"]["scatterStrengthFactor"] = 0;
    EXPECT_THAT(mapped(asset_with_extensions(trap)).warnings,
                HasSubstr("scatterStrengthFactor is 0"));
}

TEST(GltfTranslucency, WhatDescribesNoScatteringMediumIsBakedDiffuseWithAWarning) {
    const auto refused = [](const char* pointer, const Json& value) {
        Json extensions = scattering_extensions();
        extensions[Json::json_pointer(pointer)] = value;
        const Mapped result = mapped(asset_with_extensions(extensions));
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
    EXPECT_FALSE(mapped(asset_with_extensions(extensions)).medium.has_value());
}

TEST(GltfTranslucency, GlassIsAMediumThatAbsorbsAndDoesNotScatter) {
    Json glass = scattering_extensions();
    glass.erase("KHR_materials_scatter");
    glass["KHR_materials_volume"] = {
        {"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.25, 1, 0}}};
    const Mapped tinted = mapped(asset_with_extensions(glass));
    ASSERT_TRUE(tinted.medium.has_value()) << tinted.warnings;
    EXPECT_EQ(tinted.medium->sigma_s, formats::Rgb{});
    EXPECT_NEAR(tinted.medium->sigma_a.r, std::log(4.0) / 0.5, 1e-5) << "a quarter in half a metre";
    EXPECT_LT(tinted.medium->sigma_a.g, 1e-9f);
    EXPECT_GT(tinted.medium->sigma_a.b, 100);
    glass["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    const Mapped clear = mapped(asset_with_extensions(glass));
    ASSERT_TRUE(clear.medium.has_value()) << "the distance is infinite by default";
    EXPECT_GT(clear.medium->sigma_a.r, 0) << "some number, that nobody sees";
    EXPECT_LT(clear.medium->sigma_a.r, 1e-9f);
    // Without an inside, or where no light enters, there is no medium.
    glass["KHR_materials_volume"] = {{"thicknessFactor", 0}};
    EXPECT_FALSE(mapped(asset_with_extensions(glass)).medium.has_value());
    glass["KHR_materials_volume"] = {{"thicknessFactor", 1}, {"attenuationDistance", 0}};
    EXPECT_FALSE(mapped(asset_with_extensions(glass)).medium.has_value());
    glass["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    glass.erase("KHR_materials_transmission");
    const Mapped closed = mapped(asset_with_extensions(glass));
    EXPECT_FALSE(closed.medium.has_value());
    EXPECT_THAT(closed.warnings, HasSubstr("KHR_materials_volume is not simulated"));
}

TEST(GltfTranslucency, IndexOfRefractionComesFromIorAndSpecular) {
    Json extensions = scattering_extensions();
    const auto eta = [&] { return mapped(asset_with_extensions(extensions)).medium->eta; };
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
    EXPECT_THAT(mapped(asset_with_extensions(extensions)).warnings, HasSubstr("ior 0"));
    extensions["KHR_materials_ior"]["ior"] = 9;
    EXPECT_EQ(eta(), 3.0f);
}

TEST(GltfTranslucency, EveryTextureOnAFactorIsNamed) {
    Json extensions = scattering_extensions();
    extensions["KHR_materials_transmission"]["transmissionTexture"] = {{"index", 0}};
    extensions["KHR_materials_volume"]["thicknessTexture"] = {{"index", 0}};
    extensions["KHR_materials_specular"]["specularTexture"] = {{"index", 0}};
    extensions["KHR_materials_specular"]["specularColorTexture"] = {{"index", 0}};
    const Mapped result = mapped(asset_with_extensions(extensions));
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
    AssetBuilder asset = asset_with_extensions(extensions);
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
        expect_faults(asset_with_extensions(scattering_extensions()),
                      {{extensions + member, "x", "material 'Wax' > KHR_materials"},
                       {extensions + member, "x", said.c_str()}});
    }
    expect_faults(asset_with_extensions(scattering_extensions()),
                  {{extensions + "volume", 5, "KHR_materials_volume is not an object"}});
}

TEST(GltfTranslucency, FilesMayRequireWhatIsMapped) {
    AssetBuilder asset = asset_with_extensions(scattering_extensions());
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
            const auto result = import_asset(asset_with_extensions(damaged));
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
