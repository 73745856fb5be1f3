#include <limits>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

/// The square's four corners drawn as `mode`, with indices where given.
AssetBuilder square(unsigned mode, const std::vector<std::uint8_t>& index = {}) {
    AssetBuilder asset;
    Json more = {{"mode", mode}};
    const auto position = asset.add<float>(kSquare, "VEC3");
    if (!index.empty()) {
        more["indices"] = asset.add<std::uint8_t>(index, "SCALAR");
    }
    asset.add_node(asset.add_mesh({{"POSITION", position}}, more));
    return asset;
}

TEST(GltfAccessors, InterleavedAttributesAreReadWithTheirStride) {
    AssetBuilder asset;
    const std::vector<float> data = {0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0, 1};
    const auto view = asset.add_view(data.data(), data.size() * 4, 24);
    const auto position = asset.add_accessor(view, 5126, 3, "VEC3");
    const auto normal = asset.add_accessor(view, 5126, 3, "VEC3");
    asset.json["accessors"][normal]["byteOffset"] = 12u;
    asset.add_node(asset.add_mesh({{"POSITION", position}, {"NORMAL", normal}}));
    const auto imported = must_import(asset);
    const auto& primitive = imported.scene.primitives.at(0);
    EXPECT_THAT(primitive.position,
                ElementsAre(glm::vec3(0, 0, 0), glm::vec3(2, 0, 0), glm::vec3(0, 3, 0)));
    EXPECT_THAT(primitive.normal, ::testing::Each(glm::vec3(0, 0, 1)));
}

// Replaces the third position of the triangle, or one that is not there.
AssetBuilder sparse_triangle(std::uint16_t where) {
    AssetBuilder asset = triangle_asset();
    const std::vector<float> what = {0, 5, 0};
    const auto indices = asset.add_view(&where, 2), values = asset.add_view(what.data(), 12);
    asset.json["accessors"][0]["sparse"] = {
        {"count", 1u},
        {"indices", {{"bufferView", indices}, {"componentType", 5123u}}},
        {"values", {{"bufferView", values}}}};
    return asset;
}

TEST(GltfAccessors, SparseValuesReplaceStoredOnes) {
    EXPECT_EQ(must_import(sparse_triangle(2)).scene.primitives.at(0).position[2],
              glm::vec3(0, 5, 0));
    EXPECT_THAT(errors_of(import_asset(sparse_triangle(3))),
                HasSubstr("sparse index past its last element"));
    expect_faults(sparse_triangle(2),
                  {{"/accessors/0/sparse/values/bufferView", 99u, "bufferView 99 does not exist"},
                   {"/accessors/0/sparse/count", 4u, "sparse count is 4, expected 1 to 3"}});
}

TEST(GltfAccessors, SparseWithoutAViewStartsFromZero) {
    AssetBuilder asset;
    const std::vector<std::uint8_t> where = {1, 2};
    const std::vector<float> what = {4, 0, 0, 0, 5, 0};
    const auto indices = asset.add_view(where.data(), 2);
    const auto values = asset.add_view(what.data(), 24);
    asset.json["accessors"].push_back(
        {{"componentType", 5126u},
         {"count", 3u},
         {"type", "VEC3"},
         {"sparse",
          {{"count", 2u},
           {"indices", {{"bufferView", indices}, {"componentType", 5121u}}},
           {"values", {{"bufferView", values}}}}}});
    // Indices without a view as well: all zero but for the sparse ones.
    asset.json["accessors"].push_back(asset.json["accessors"][0]);
    Json& index = asset.json["accessors"][1];
    const std::vector<std::uint16_t> corners = {1, 2};
    const auto corner_view = asset.add_view(corners.data(), 4);
    index["componentType"] = 5123u;
    index["type"] = "SCALAR";
    index["sparse"]["values"]["bufferView"] = corner_view;
    asset.add_node(asset.add_mesh({{"POSITION", 0u}}, {{"indices", 1u}}));
    const auto imported = must_import(asset);
    const auto& primitive = imported.scene.primitives.at(0);
    EXPECT_THAT(primitive.position,
                ElementsAre(glm::vec3(0, 0, 0), glm::vec3(4, 0, 0), glm::vec3(0, 5, 0)));
    EXPECT_THAT(primitive.index, ElementsAre(0u, 1u, 2u));
}

TEST(GltfAccessors, QuantizedPositionsKeepOrNormaliseTheirIntegers) {
    AssetBuilder asset;
    const auto add = [&](std::size_t accessor) {
        asset.add_node(asset.add_mesh({{"POSITION", accessor}}));
    };
    const auto padded = [&](const auto& values, bool normalized) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        const auto view = asset.add_view(values.data(), values.size() * sizeof(T), 4 * sizeof(T));
        return asset.add_accessor(view, AssetBuilder::component_type(T{}), 3, "VEC3", normalized);
    };
    add(padded(std::vector<std::int8_t>{0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0, 0}, true));
    add(padded(std::vector<std::uint8_t>{0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0, 0}, true));
    add(padded(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, -300, 0, 0}, false));
    add(padded(std::vector<std::uint16_t>{0, 0, 0, 0, 65535, 0, 0, 0, 0, 13107, 0, 0}, true));
    const auto scene = must_import(asset).scene;
    ASSERT_EQ(scene.primitives.size(), 4u);
    const auto corner = [&](std::size_t p, std::size_t v) {
        return scene.primitives[p].position[v];
    };
    EXPECT_EQ(corner(0, 1), glm::vec3(1, 0, 0));
    EXPECT_EQ(corner(0, 2), glm::vec3(0, -1, 0));  // -128 / 127 is clamped
    EXPECT_EQ(corner(1, 2), glm::vec3(0, 0.2f, 0));
    EXPECT_EQ(corner(2, 1), glm::vec3(32767, 0, 0));
    EXPECT_EQ(corner(2, 2), glm::vec3(0, -300, 0));
    EXPECT_EQ(corner(3, 2), glm::vec3(0, 0.2f, 0));
}

TEST(GltfAccessors, QuantizedNormalsBecomeUnit) {
    AssetBuilder asset = triangle_asset();
    const std::vector<std::int8_t> normals = {0, 90, 90, 0, 0, 0, 127, 0, -127, 0, 0, 0};
    const auto view = asset.add_view(normals.data(), normals.size(), 4);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add_accessor(view, 5120, 3, "VEC3", true);
    const auto imported = must_import(asset);
    const auto& normal = imported.scene.primitives.at(0).normal;
    const float s = std::sqrt(0.5f);
    EXPECT_NEAR(normal[0].y, s, 1e-6f);  // single-precision rounding
    EXPECT_NEAR(normal[0].z, s, 1e-6f);
    EXPECT_EQ(normal[1], glm::vec3(0, 0, 1));
    EXPECT_EQ(normal[2], glm::vec3(-1, 0, 0));
}

TEST(GltfAccessors, StripsFansAndUnindexedBecomeTriangles) {
    // The specification's corner orders.
    const auto strip = must_import(square(5));
    EXPECT_THAT(strip.scene.primitives.at(0).index, ElementsAre(0u, 1u, 2u, 1u, 3u, 2u));
    EXPECT_THAT(strip.scene.primitives[0].normal, ::testing::Each(glm::vec3(0, 0, 1)));
    EXPECT_THAT(must_import(square(6, {0, 1, 3, 2})).scene.primitives.at(0).index,
                ElementsAre(1u, 3u, 0u, 3u, 2u, 0u));
    EXPECT_THAT(must_import(square(5, {3, 2, 1, 0})).scene.primitives.at(0).index,
                ElementsAre(3u, 2u, 1u, 2u, 0u, 1u));
    const auto ragged = must_import(square(4));  // four corners: one triangle and a rest
    EXPECT_THAT(ragged.scene.primitives.at(0).index, ElementsAre(0u, 1u, 2u));
    EXPECT_THAT(lines(ragged.warnings), HasSubstr("4 corners are no multiple of 3"));
}

TEST(GltfAccessors, IndexPastTheVerticesNamesItself) {
    EXPECT_THAT(errors_of(import_asset(square(4, {0, 1, 4}))),
                HasSubstr("node 0 > mesh 0 > primitive 0: index 2 is 4, but there are 4 vertices"));
}

TEST(GltfAccessors, CountMismatchNamesBothCounts) {
    AssetBuilder asset = triangle_asset();
    asset.json["nodes"][0]["name"] = "Vase";
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 1, 0, 0, 1}, "VEC3");
    EXPECT_EQ(errors_of(import_asset(asset)),
              "node 'Vase' > mesh 0 > primitive 0: NORMAL has 2 values but POSITION has 3 (export "
              "with one normal per vertex, or drop NORMAL to have it computed)\n");
}

TEST(GltfAccessors, OutOfRangeViewsAndAccessorsAreAllNamed) {
    AssetBuilder asset = triangle_asset();
    asset.json["bufferViews"].push_back({{"buffer", 0u}, {"byteLength", 1000u}});
    asset.json["bufferViews"].push_back({{"buffer", 7u}, {"byteLength", 4u}});
    asset.json["accessors"][0]["count"] = 4u;
    asset.json["accessors"].push_back(
        {{"bufferView", 0u}, {"componentType", 5124u}, {"count", 1u}, {"type", "SCALAR"}});
    asset.json["accessors"].push_back({{"bufferView", 0u},
                                       {"byteOffset", 2u},
                                       {"componentType", 5126u},
                                       {"count", 1u},
                                       {"type", "SCALAR"}});
    const std::string errors = errors_of(import_asset(asset));
    EXPECT_THAT(errors, HasSubstr("bufferView 1: its bytes 0 to 1000 pass the end of buffer 0"));
    EXPECT_THAT(errors, HasSubstr("bufferView 2: buffer 7 does not exist"));
    EXPECT_THAT(errors, HasSubstr("accessor 0: 4 elements from byte 0 pass the end of bufferView"));
    EXPECT_THAT(errors, HasSubstr("accessor 1: componentType 5124 is not one of glTF"));
    EXPECT_THAT(errors, HasSubstr("accessor 2: byteOffset 2 or byteStride 4 is not a multiple"));
}

TEST(GltfAccessors, RangesThatWouldWrapAreRefused) {
    const std::uint64_t huge = std::numeric_limits<std::uint64_t>::max() - 3;
    for (const char* key : {"/accessors/0/byteOffset", "/accessors/0/count"}) {
        expect_faults(triangle_asset(), {{key, huge, "expected a whole number"},
                                         {key, std::uint64_t{1} << 30, "pass the end"}});
    }
    for (const Json& bad : {Json(-1), Json(1.5), Json("1"), Json(nullptr), Json(1e300)}) {
        expect_faults(triangle_asset(), {{"/bufferViews/0/byteOffset", bad, "byteOffset is"}});
    }
}

TEST(GltfAccessors, NanPositionNamesItsVertex) {
    AssetBuilder asset;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto position = asset.add<float>({0, 0, 0, 1, nan, 0, 0, 1, 0}, "VEC3");
    asset.add_node(asset.add_mesh({{"POSITION", position}}));
    EXPECT_THAT(errors_of(import_asset(asset)),
                HasSubstr("node 0 > mesh 0 > primitive 0: POSITION of vertex 1 is not finite"));
}

TEST(GltfAccessors, WrongShapesAreRefused) {
    AssetBuilder asset = triangle_asset();
    const auto floats = asset.add<float>({0, 1, 2}, "SCALAR");
    expect_faults(asset, {{"/accessors/0/type", "VEC2", "POSITION has 2 x FLOAT per vertex"},
                          {"/meshes/0/primitives/0/attributes", Json::object(),
                           "it has no POSITION attribute"},
                          {"/meshes/0/primitives/0/indices", floats, "its indices are 1 x FLOAT"}});
}

TEST(GltfAccessors, ManyElementsOutOfNothingAreRefused) {
    AssetBuilder asset = triangle_asset();
    asset.json["accessors"][0].erase("bufferView");
    asset.json["accessors"][0]["count"] = 2'000'000'000u;
    const auto result = import_asset(asset);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, formats::ErrorKind::resource);
}

}  // namespace
}  // namespace opaline::tests
