#include "tests/formats/gltf/asset_builder.h"
#include "tests/formats/gltf/encode_test_image.h"

namespace opaline::tests {
namespace {

using formats::Material;
using formats::Rgb;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// The triangle with texture coordinates and a material whose base colour is `image`.
AssetBuilder textured(const Blob& image) {
    AssetBuilder asset = textured_triangle(
        {{"name", "Paint"},
         {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0u}}}}}});
    add_texture(asset, image, {{"name", "Grain"}});
    return asset;
}

const Blob kTwoPixels = {255, 0, 0, 255, 0, 128, 255, 64};

TEST(GltfMaterials, WithoutOneAPrimitiveGetsAWhiteDefault) {
    const auto imported = must_import(triangle_asset());
    ASSERT_EQ(imported.scene.materials.size(), 1u);
    EXPECT_EQ(imported.scene.primitives.at(0).material, 0u);
    EXPECT_EQ(imported.scene.materials[0].base_color, (Rgb{1, 1, 1}));
    EXPECT_FALSE(imported.scene.materials[0].double_sided);
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfMaterials, DefaultComesBehindTheFilesOwn) {
    AssetBuilder asset = triangle_asset();
    asset.json["materials"] =
        Json::array({{{"doubleSided", true},
                      {"pbrMetallicRoughness",
                       {{"baseColorFactor", {0.5, 0.25, 0, 1}}, {"metallicFactor", 0}}}}});
    Json other = asset.json["meshes"][0]["primitives"][0];
    other["material"] = 0u;
    asset.json["meshes"][0]["primitives"].push_back(other);
    const auto imported = must_import(asset);
    ASSERT_EQ(imported.scene.materials.size(), 2u);
    EXPECT_EQ(imported.scene.primitives.at(0).material, 1u);
    EXPECT_EQ(imported.scene.primitives.at(1).material, 0u);
    EXPECT_EQ(imported.scene.materials[0].base_color, (Rgb{0.5f, 0.25f, 0}));
    EXPECT_TRUE(imported.scene.materials[0].double_sided);
}

TEST(GltfMaterials, PngTextureKeepsItsStoredValues) {
    const auto imported = must_import(textured(encode_png(kTwoPixels, 2, 1)));
    ASSERT_EQ(imported.scene.images.size(), 1u);
    EXPECT_EQ(imported.scene.images[0].width, 2u);
    EXPECT_EQ(imported.scene.images[0].height, 1u);
    EXPECT_EQ(imported.scene.images[0].rgba, kTwoPixels);
    EXPECT_EQ(imported.scene.materials[0].base_color_image, 0u);
    EXPECT_THAT(imported.scene.primitives.at(0).texcoord,
                ElementsAre(glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)));
}

TEST(GltfMaterials, GreyPngAndJpegBecomeColour) {
    const auto png = must_import(textured(encode_png({10, 200}, 2, 1, TestImage::grey)));
    EXPECT_THAT(png.scene.images.at(0).rgba, ElementsAre(10, 10, 10, 255, 200, 200, 200, 255));
    const auto jpeg = must_import(textured(encode_jpeg(100, 16)));
    ASSERT_EQ(jpeg.scene.images.size(), 1u);
    ASSERT_EQ(jpeg.scene.images[0].rgba.size(), 16u * 16u * 4u);
    for (std::size_t i = 0; i < jpeg.scene.images[0].rgba.size(); ++i) {
        // One grey is exact but for quantisation of its only coefficient.
        EXPECT_NEAR(jpeg.scene.images[0].rgba[i], i % 4 == 3 ? 255 : 100, 2);
    }
}

TEST(GltfMaterials, ExternalAndDataUriTexturesAreRead) {
    const Blob png = encode_png(kTwoPixels, 2, 1);
    AssetBuilder asset = textured(png);
    asset.json["images"][0] = {{"uri", "data:image/png;base64," + base64(png)}};
    EXPECT_EQ(must_import(asset).scene.images.at(0).rgba, kTwoPixels);

    asset.json["images"][0] = {{"uri", "paint.png"}};
    const TemporaryFolder folder;
    write_file(folder / "a.glb", asset.glb());
    write_file(folder / "paint.png", png);
    const auto result = formats::import_gltf(folder / "a.glb");
    ASSERT_TRUE(result.has_value()) << errors_of(result);
    EXPECT_EQ(result->scene.images.at(0).rgba, kTwoPixels);
    EXPECT_THAT(result->scene.inputs, ElementsAre(folder / "a.glb", folder / "paint.png"));
}

TEST(GltfMaterials, MissingOrDamagedTexturesAreErrorsThatNameTheImage) {
    AssetBuilder asset = textured(encode_png(kTwoPixels, 2, 1));
    asset.json["images"][0] = {{"name", "Grain"}, {"uri", "none.png"}};
    EXPECT_THAT(errors_of(import_asset(asset)),
                HasSubstr("image 'Grain' ('none.png'): the file cannot be found"));
    EXPECT_THAT(errors_of(import_asset(textured({1, 2, 3}))),
                HasSubstr("image 'Grain': its 3 bytes are neither PNG nor JPEG"));
}

TEST(GltfMaterials, EveryTruncatedTextureIsAnError) {
    for (const Blob& whole : {encode_png(kTwoPixels, 2, 1), encode_jpeg(100, 32)}) {
        const std::size_t tail = whole[0] == 0xff ? 2 : 12;  // the end marker may be missing
        for (std::size_t size = 1; size + tail < whole.size(); ++size) {
            const auto result =
                import_asset(textured(Blob(whole.begin(), whole.begin() + long(size))));
            EXPECT_THAT(errors_of(result), HasSubstr("image 'Grain'")) << size;
        }
    }
}

TEST(GltfMaterials, TexturesThatNoUsedMaterialNeedsAreNotRead) {
    AssetBuilder asset = textured({1, 2, 3});
    asset.json["meshes"][0]["primitives"][0].erase("material");
    EXPECT_TRUE(must_import(asset).scene.images.empty());
}

TEST(GltfMaterials, SamplerWrapModesAreKept) {
    AssetBuilder asset = textured(encode_png(kTwoPixels, 2, 1));
    asset.json["samplers"] = Json::array({{{"wrapS", 33071u}, {"wrapT", 33648u}}});
    asset.json["textures"][0]["sampler"] = 0u;
    const Material material = must_import(asset).scene.materials.at(0);
    EXPECT_EQ(material.wrap_u, Material::Wrap::clamp);
    EXPECT_EQ(material.wrap_v, Material::Wrap::mirror);
    asset.json["samplers"][0]["wrapS"] = 7u;
    EXPECT_THAT(errors_of(import_asset(asset)), HasSubstr("wrap mode 7"));
}

TEST(GltfMaterials, NearestSamplersAreKept) {
    AssetBuilder asset = textured(encode_png(kTwoPixels, 2, 1));
    asset.json["textures"][0]["sampler"] = 0u;
    const auto wrap_of = [&](const Json& sampler) {
        asset.json["samplers"] = Json::array({sampler});
        return must_import(asset).scene.materials.at(0).wrap_u;
    };
    using Wrap = formats::TextureWrap;
    EXPECT_EQ(wrap_of({{"magFilter", 9728u}}), Wrap::nearest_repeat);
    EXPECT_EQ(wrap_of({{"magFilter", 9728u}, {"wrapS", 33071u}}), Wrap::nearest_clamp);
    EXPECT_EQ(wrap_of({{"magFilter", 9728u}, {"minFilter", 9987u}, {"wrapS", 33648u}}),
              Wrap::nearest_mirror);
    EXPECT_EQ(wrap_of({{"minFilter", 9984u}}), Wrap::nearest_repeat);
    EXPECT_EQ(wrap_of({{"minFilter", 9986u}}), Wrap::nearest_repeat);
    EXPECT_EQ(wrap_of({{"magFilter", 9729u}, {"minFilter", 9728u}}), Wrap::repeat);
    EXPECT_EQ(wrap_of({{"minFilter", 9987u}}), Wrap::repeat);
    EXPECT_EQ(wrap_of(Json::object({{"name", "none"}})), Wrap::repeat);
}

TEST(GltfMaterials, TextureTransformMatchesTheExtensionsExample) {
    // The extension's own example: offset (0, 1), a quarter turn, half size is the lower left
    // quadrant of the image (v down: u in 0 to 1/2, v in 1/2 to 1), turned.
    AssetBuilder asset = textured(encode_png(kTwoPixels, 2, 1));
    const auto other = asset.add<float>({0, 0, 1, 0, 1, 1}, "VEC2");
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = other;
    asset.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
              ["KHR_texture_transform"] = {
        {"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}, {"texCoord", 1u}};
    const auto imported = must_import(asset);
    const auto& uv = imported.scene.primitives.at(0).texcoord;
    ASSERT_EQ(uv.size(), 3u);
    const glm::vec2 expected[3] = {{0, 1}, {0, 0.5f}, {0.5f, 0.5f}};
    for (int i = 0; i < 3; ++i) {
        EXPECT_LT(glm::length(uv[i] - expected[i]), 1e-6f) << i;  // digits of pi/2 above
    }
    EXPECT_EQ(imported.scene.materials[0].base_color_texcoord, 1u);
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfMaterials, MissingTextureCoordinatesAreAWarning) {
    AssetBuilder asset = textured(encode_png(kTwoPixels, 2, 1));
    asset.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    const auto imported = must_import(asset);
    EXPECT_TRUE(imported.scene.primitives.at(0).texcoord.empty());
    EXPECT_THAT(lines(imported.warnings), HasSubstr("TEXCOORD_0 is missing"));
}

TEST(GltfMaterials, TextureCoordinatesAreKeptWithoutATexture) {
    AssetBuilder asset = textured(encode_png(kTwoPixels, 2, 1));
    asset.json["materials"][0]["pbrMetallicRoughness"].erase("baseColorTexture");
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.primitives.at(0).texcoord.size(), 3u);
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfMaterials, VertexColoursOfEveryTypeAreLinear) {
    const auto color_of = [](const auto& values, const char* type, bool normalized) {
        AssetBuilder asset = triangle_asset();
        asset.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            asset.add(values, type, normalized);
        return must_import(asset);
    };
    const Rgb expected{1, 0.2f, 0};
    const auto check = [&](const formats::ImportedScene& imported) {
        ASSERT_EQ(imported.scene.primitives.at(0).color.size(), 3u);
        EXPECT_EQ(imported.scene.primitives[0].color[1], expected);
    };
    check(color_of(std::vector<float>{0, 0, 0, 1, 0.2f, 0, 0, 0, 0}, "VEC3", false));
    check(color_of(std::vector<std::uint8_t>{0, 0, 0, 0, 255, 51, 0, 9, 0, 0, 0, 0}, "VEC4", true));
    check(color_of(std::vector<std::uint16_t>{0, 0, 0, 0, 65535, 13107, 0, 9, 0, 0, 0, 0}, "VEC4",
                   true));
    const auto wild = color_of(std::vector<float>{0, 0, 0, 7, 0.2f, -1, 0, 0, 0}, "VEC3", false);
    check(wild);
    EXPECT_THAT(lines(wild.warnings), HasSubstr("2 values of COLOR_0 were outside [0, 1]"));
}

TEST(GltfMaterials, EverythingThatIsNotSimulatedIsNamedOnce) {
    AssetBuilder asset = triangle_asset();
    Json material = {{"name", "Jade"},
                     {"alphaMode", "DITHER"},
                     {"pbrMetallicRoughness", {{"baseColorFactor", {2, 1, 1, 1}}}},
                     {"extensions",
                      {{"KHR_materials_volume", {{"thicknessFactor", 1}}},
                       {"KHR_materials_scatter", Json::object({{"x", 1}})},
                       {"VENDOR_glow", {{"x", 1}}}}}};
    asset.json["materials"] = Json::array({material, material});
    asset.json["materials"][1]["name"] = "Onyx";
    Json other = asset.json["meshes"][0]["primitives"][0];
    asset.json["meshes"][0]["primitives"][0]["material"] = 0u;
    other["material"] = 1u;
    asset.json["meshes"][0]["primitives"].push_back(other);
    const std::string warnings = lines(must_import(asset).warnings);
    for (const char* name :
         {"KHR_materials_volume", "KHR_materials_scatter", "'VENDOR_glow'", "alphaMode 'DITHER'"}) {
        EXPECT_THAT(warnings, HasSubstr(std::string("material 'Jade', material 'Onyx': ")));
        const auto first = warnings.find(name);
        ASSERT_NE(first, std::string::npos) << name << "\n" << warnings;
        EXPECT_EQ(warnings.find(name, first + 1), std::string::npos) << name;
    }
    EXPECT_THAT(warnings, HasSubstr("baseColorFactor was outside [0, 1]"));
}

TEST(GltfMaterials, UnusedMaterialsGiveNoWarnings) {
    AssetBuilder asset = triangle_asset();
    asset.json["materials"] = Json::array({{{"alphaMode", "DITHER"}}});
    EXPECT_THAT(lines(must_import(asset).warnings), Not(HasSubstr("alphaMode")));
}

}  // namespace
}  // namespace opaline::tests
