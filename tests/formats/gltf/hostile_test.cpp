#include <cmath>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using ::testing::HasSubstr;

/// Something of everything, still small: interleaving aside, every reader is entered.
AssetBuilder rich_asset() {
    AssetBuilder asset = triangle_asset();
    Json& primitive = asset.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] =
        asset.add<std::uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, "VEC4", true);
    primitive["indices"] = asset.add<std::uint16_t>({0, 1, 2}, "SCALAR");
    primitive["material"] = 0u;
    asset.json["materials"] = Json::array(
        {{{"name", "m"},
          {"alphaMode", "MASK"},
          {"alphaCutoff", 0.5},
          {"emissiveFactor", {1, 1, 0}},
          {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}}}}});
    asset.json["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", "spot"},
                      {"intensity", 3},
                      {"color", {1, 1, 1}},
                      {"range", 9},
                      {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}});
    asset.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
        {"diffuseFactor", {1, 0.5, 0, 1}}, {"glossinessFactor", 0.5}};
    primitive["attributes"]["JOINTS_0"] = asset.add<std::uint8_t>(Blob(12, 0), "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = asset.add<std::uint8_t>(Blob(12, 255), "VEC4", true);
    primitive["targets"] =
        Json::array({{{"POSITION", asset.add<std::int8_t>({0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3")}}});
    asset.json["meshes"][0]["weights"] = {1};
    asset.json["skins"] = Json::array({{{"joints", {1u}}}});
    asset.json["nodes"][0]["skin"] = 0u;
    asset.json["nodes"].push_back({{"children", {0u}}, {"rotation", {0, 0, 0, 1}}});
    asset.json["nodes"][1]["mesh"] = 0u;
    asset.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        asset.add<float>({1, 2, 3}, "VEC3");
    asset.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0u;
    asset.json["scenes"][0]["nodes"] = {1u};
    return asset;
}

/// What every accepted scene promises to the baker.
void expect_sound(const formats::Scene& scene) {
    ASSERT_FALSE(scene.materials.empty());
    for (const auto& m : scene.materials) {
        for (const float band : {m.emission.r, m.emission.g, m.emission.b}) {
            ASSERT_TRUE(band >= 0 && band <= 1e12f);
        }
        ASSERT_TRUE(m.alpha >= 0 && m.alpha <= 1 && m.alpha_cutoff >= 0);
    }
    for (const auto& light : scene.lights) {
        ASSERT_FALSE(light.name.empty());
        ASSERT_TRUE(light.intensity.r >= 0 && light.intensity.r <= 1e12f);
        ASSERT_TRUE(std::isfinite(glm::dot(light.position, glm::vec3(1))));
        ASSERT_LT(std::abs(glm::length(light.direction) - 1.0f), 1e-5f);
        ASSERT_TRUE(light.range >= 0 && std::isfinite(light.range));
        ASSERT_TRUE(0 <= light.inner_cone && light.inner_cone < light.outer_cone);
        ASSERT_LE(light.outer_cone, 1.5707964f);
    }
    for (const auto& p : scene.primitives) {
        ASSERT_LT(p.material, scene.materials.size());
        ASSERT_EQ(p.normal.size(), p.position.size());
        ASSERT_TRUE(p.texcoord.empty() || p.texcoord.size() == p.position.size());
        ASSERT_TRUE(p.color.empty() || p.color.size() == p.position.size());
        ASSERT_EQ(p.index.size() % 3, 0u);
        for (std::size_t v = 0; v < p.position.size(); ++v) {
            ASSERT_TRUE(std::isfinite(glm::dot(p.position[v], glm::vec3(1))));
            const float length = glm::length(p.normal[v]);
            ASSERT_TRUE(length == 0.0f || std::abs(length - 1.0f) < 1e-5f);
        }
        for (const auto i : p.index) {
            ASSERT_LT(i, p.position.size());
        }
    }
}

TEST(GltfHostile, EveryTruncatedPrefixIsRefused) {
    const Blob whole = rich_asset().glb();
    ASSERT_TRUE(import_bytes(whole).has_value()) << errors_of(import_bytes(whole));
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto result = import_bytes(Blob(whole.begin(), whole.begin() + long(size)));
        ASSERT_FALSE(result.has_value()) << size;
        ASSERT_EQ(result.error().kind, ErrorKind::bad_input) << size;
        ASSERT_FALSE(result.error().diagnostics.empty());
    }
}

TEST(GltfHostile, SingleFlippedBitsGiveASoundSceneOrAMessage) {
    const Blob whole = rich_asset().glb();
    std::size_t refused = 0;
    for (std::size_t bit = 0; bit < whole.size() * 8; bit += 5) {
        Blob damaged = whole;
        damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
        const auto result = import_bytes(damaged);
        if (result) {
            expect_sound(result->scene);
        } else {
            ++refused;
            ASSERT_FALSE(result.error().diagnostics.empty());
        }
        ASSERT_FALSE(HasFatalFailure()) << bit;
    }
    EXPECT_GT(refused, whole.size());  // most bits of the JSON matter
}

TEST(GltfHostile, ReplacedNumbersGiveASoundSceneOrAMessage) {
    // Where bit flips rarely lead: each number of the JSON replaced by each of these.
    const Json values = {0u,          1u,          2u,         3u,   255u,          65536u,
                         2147483647u, 4294967295u, 1ull << 40, -1,   0.5,           -1e30,
                         1e300,       nullptr,     "x",        true, Json::array(), Json::object()};
    const AssetBuilder whole = rich_asset();
    const Json flat = whole.json.flatten();
    for (const auto& [path, old] : flat.items()) {
        for (const Json& value : values) {
            AssetBuilder damaged = whole;
            damaged.json[Json::json_pointer(path)] = value;
            const auto result = import_asset(damaged);
            if (result) {
                expect_sound(result->scene);
            }
            ASSERT_FALSE(HasFatalFailure()) << path << " = " << value;
        }
    }
}

TEST(GltfHostile, DeepNestingIsRefusedBeforeAnyParser) {
    for (const std::string open : {"[", "{\"a\":"}) {
        std::string text = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
        for (int i = 0; i < 20000; ++i) {
            text += open;
        }
        EXPECT_THAT(errors_of(import_text(text)), HasSubstr("nests deeper than 64 levels"));
    }
    // Brackets inside strings are no nesting.
    EXPECT_THAT(errors_of(import_text("{\"asset\":{\"version\":\"2.0\"},\"extras\":\"" +
                                      std::string(20000, '[') + "\\\"[\"}")),
                HasSubstr("no triangles"));
}

TEST(GltfHostile, TooManyValuesAreRefusedBeforeAnyParser) {
    std::string text = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}";
    for (int i = 0; i < 1'100'000; ++i) {
        text += ",{}";
    }
    const auto result = import_text(text + "]}");
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::resource);
}

TEST(GltfHostile, WrongTypesAtTheTopAreRefused) {
    for (const char* name : {"accessors", "buffers", "bufferViews", "images", "materials", "meshes",
                             "nodes", "samplers", "scenes", "textures", "animations"}) {
        for (const Json& bad :
             {Json(1), Json("x"), Json::object(), Json::array({1}), Json::array({nullptr})}) {
            AssetBuilder asset = rich_asset();
            asset.json[name] = bad;
            ASSERT_THAT(
                errors_of(import_text(asset.text())),
                ::testing::AnyOf(HasSubstr("is not an array of objects"), ::testing::IsEmpty()))
                << name;
        }
    }
}

TEST(GltfHostile, BinaryHeaderLengthsAreChecked) {
    Blob wrong_version = rich_asset().glb();
    wrong_version[4] = 1;
    EXPECT_THAT(errors_of(import_bytes(wrong_version)), HasSubstr("container version is 1"));
    Blob long_chunk = rich_asset().glb();
    long_chunk[15] = 0xff;
    EXPECT_THAT(errors_of(import_bytes(long_chunk)), HasSubstr("bytes, but only"));
    Blob trailing = rich_asset().glb();
    trailing.resize(trailing.size() + 5);
    const auto accepted = import_bytes(trailing);
    ASSERT_TRUE(accepted.has_value());
    EXPECT_THAT(lines(accepted->warnings), HasSubstr("5 bytes after the end"));
}

TEST(GltfHostile, ErrorsAreBoundedInNumber) {
    AssetBuilder asset = triangle_asset();
    for (int i = 0; i < 1000; ++i) {
        asset.json["bufferViews"].push_back({{"buffer", 5u}, {"byteLength", 1u}});
    }
    const auto result = import_asset(asset);
    ASSERT_FALSE(result.has_value());
    EXPECT_LE(result.error().diagnostics.size(), 65u);
    EXPECT_THAT(errors_of(result), HasSubstr("more errors are left out"));
}

}  // namespace
}  // namespace opaline::tests
