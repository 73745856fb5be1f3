#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

glm::vec3 face_normal(const formats::Primitive& p) {
    const glm::vec3 a = p.position[p.index[0]];
    return glm::normalize(glm::cross(p.position[p.index[1]] - a, p.position[p.index[2]] - a));
}

void expect_near(glm::vec3 a, glm::vec3 b, float tolerance) {
    EXPECT_LE(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(GltfHierarchy, TransformsComposeFromRootToLeaf) {
    AssetBuilder asset = triangle_asset();
    // Child: +1 along x. Parent: a quarter turn about y (x to -z), then twice as large, then up.
    asset.json["nodes"][0]["translation"] = {1, 0, 0};
    const double h = std::sqrt(0.5);
    asset.json["nodes"].push_back({{"children", {0u}},
                                   {"rotation", {0, h, 0, h}},
                                   {"scale", {2, 2, 2}},
                                   {"translation", {0, 10, 0}}});
    asset.json["scenes"][0]["nodes"] = {1u};
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    EXPECT_EQ(p.node, 0u);
    expect_near(p.position[0], {0, 10, -2}, 1e-6f);  // rounding of the quaternion's digits
    expect_near(p.position[1], {0, 10, -4}, 1e-6f);
    expect_near(p.position[2], {0, 12, -2}, 1e-6f);
    expect_near(p.normal[0], {1, 0, 0}, 1e-6f);
}

TEST(GltfHierarchy, MatrixIsColumnMajor) {
    AssetBuilder asset = triangle_asset();
    asset.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    EXPECT_EQ(must_import(asset).scene.primitives.at(0).position[0], glm::vec3(5, 6, 7));
    expect_faults(asset, {{"/nodes/0/matrix/3", 1, "the last row of its matrix"},
                          {"/nodes/0/matrix", {1, 2, 3}, "matrix is not an array of 16 numbers"}});
}

TEST(GltfHierarchy, ASceneNearTheWorldsOriginKeepsItsCoordinates) {
    AssetBuilder asset = triangle_asset();
    for (const double x : {0.0, 0.3, 5.0}) {
        asset.json["nodes"][0]["translation"] = {x, 0, -x};
        const auto scene = must_import(asset).scene;
        EXPECT_EQ(scene.origin, glm::dvec3(0)) << x;
        EXPECT_EQ(scene.primitives[0].position[0].x, static_cast<float>(x));
    }
}

// A scene moved by its node keeps the float coordinates that it has at the origin.
TEST(GltfHierarchy, ADistantSceneHasAFrameOfItsOwn) {
    AssetBuilder asset = triangle_asset();
    const auto here = must_import(asset).scene;
    for (const double x : {1e3, 12345.5, 1e6}) {
        asset.json["nodes"][0]["translation"] = {x, 0, -x};
        const auto imported = must_import(asset);
        const auto& scene = imported.scene;
        EXPECT_NEAR(scene.origin.x, x, 1);
        EXPECT_EQ(scene.origin.y, 0) << "not far along this axis";
        EXPECT_NEAR(scene.origin.z, -x, 1);
        for (std::size_t v = 0; v < 3; ++v) {
            const glm::dvec3 world = scene.to_world(scene.primitives[0].position[v]);
            const glm::dvec3 expected =
                glm::dvec3(x, 0, -x) + glm::dvec3(here.primitives[0].position[v]);
            EXPECT_EQ(world, expected) << x;
        }
    }
    EXPECT_THAT(lines(must_import(triangle_asset()).warnings), testing::Not(HasSubstr("spacing")));
}

TEST(GltfHierarchy, PositionsThatFloatsAreTooCoarseForAreWarnedOf) {
    const auto triangle_at = [](float x, float size) {
        AssetBuilder asset;
        const auto position = asset.add<float>({x, 0, 0, x + size, 0, 0, x, size, 0}, "VEC3");
        asset.add_node(asset.add_mesh({{"POSITION", position}}));
        return asset;
    };
    EXPECT_THAT(lines(must_import(triangle_at(1000, 0.1f)).warnings),
                testing::Not(HasSubstr("spacing")));
    EXPECT_THAT(lines(must_import(triangle_at(1000, 0.002f)).warnings),
                HasSubstr("its POSITION values are so large that their float spacing is"));
    AssetBuilder large = triangle_at(0, 0.002f);
    large.add_node(0, {{"translation", {5000, 0, 0}}});
    EXPECT_THAT(lines(must_import(large).warnings), HasSubstr("the scene is so large"));
    AssetBuilder far = triangle_at(0, 0.002f);
    far.json["nodes"][0]["translation"] = {5000, 0, 0};
    EXPECT_THAT(lines(must_import(far).warnings),
                HasSubstr("so far from the world's origin that the float spacing"));
}

TEST(GltfHierarchy, MirroredInstancesStayCounterClockwiseOutside) {
    AssetBuilder asset = triangle_asset();
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    asset.add_node(0, {{"scale", {-1, 1, 1}}});
    asset.add_node(0, {{"scale", {1, 1, -3}}});
    asset.add_node(0, {{"scale", {-1, -1, 1}}});
    const auto scene = must_import(asset).scene;
    ASSERT_EQ(scene.primitives.size(), 4u);
    for (const auto& p : scene.primitives) {
        EXPECT_GT(glm::dot(face_normal(p), p.normal[0]), 0.99f) << p.name;
    }
    EXPECT_EQ(face_normal(scene.primitives[1]), glm::vec3(0, 0, 1));
    EXPECT_EQ(face_normal(scene.primitives[2]), glm::vec3(0, 0, -1));
}

TEST(GltfHierarchy, NormalsFollowTheInverseTranspose) {
    // The plane x + y = 1 scaled by 4 along x is x/4 + y = 1, whose normal is (1/4, 1).
    AssetBuilder asset;
    const auto position = asset.add<float>({1, 0, 0, 0, 1, 0, 1, 0, 1}, "VEC3");
    const float h = std::sqrt(0.5f);
    const auto normal = asset.add<float>({h, h, 0, h, h, 0, h, h, 0}, "VEC3");
    asset.add_node(asset.add_mesh({{"POSITION", position}, {"NORMAL", normal}}),
                   {{"scale", {4, 1, 1}}});
    expect_near(must_import(asset).scene.primitives.at(0).normal[0],
                glm::normalize(glm::vec3(0.25f, 1, 0)), 1e-6f);
}

TEST(GltfHierarchy, RunningNumberIsDepthFirstThenPrimitives) {
    AssetBuilder asset = triangle_asset();
    Json& mesh = asset.json["meshes"][0];
    mesh["primitives"].push_back(mesh["primitives"][0]);
    mesh["primitives"][0]["mode"] = 1u;  // lines keep their number
    asset.json["nodes"] = Json::array({{{"name", "leaf"}, {"mesh", 0u}},
                                       {{"children", {3u, 0u}}},
                                       {{"name", "last"}, {"mesh", 0u}},
                                       {{"name", "first"}, {"mesh", 0u}}});
    asset.json["scenes"][0]["nodes"] = {1u, 2u};
    const auto imported = must_import(asset);
    std::vector<std::string> names;
    for (const auto& p : imported.scene.primitives) {
        names.push_back(p.name);
    }
    EXPECT_THAT(
        names,
        ElementsAre("node 'first' > mesh 0 > primitive 0", "node 'first' > mesh 0 > primitive 1",
                    "node 'leaf' > mesh 0 > primitive 0", "node 'leaf' > mesh 0 > primitive 1",
                    "node 'last' > mesh 0 > primitive 0", "node 'last' > mesh 0 > primitive 1"));
    EXPECT_TRUE(imported.scene.primitives[0].position.empty());
    EXPECT_EQ(imported.scene.primitives[1].position.size(), 3u);
    EXPECT_THAT(lines(imported.warnings), HasSubstr("points and lines are not simulated"));
}

TEST(GltfHierarchy, WithoutScenesAllRootsAreRead) {
    AssetBuilder asset = triangle_asset();
    asset.json.erase("scenes");
    asset.json.erase("scene");
    asset.json["nodes"].push_back({{"mesh", 0u}});
    EXPECT_EQ(must_import(asset).scene.primitives.size(), 2u);
}

TEST(GltfHierarchy, OnlyTheDefaultSceneIsReadAndTheOthersAreNamed) {
    AssetBuilder asset = triangle_asset();
    asset.json["nodes"].push_back({{"mesh", 0u}});
    asset.json["scenes"].push_back({{"nodes", {1u}}});
    asset.json["scene"] = 1u;
    const auto imported = must_import(asset);
    ASSERT_EQ(imported.scene.primitives.size(), 1u);
    EXPECT_EQ(imported.scene.primitives[0].node, 1u);
    EXPECT_THAT(lines(imported.warnings), HasSubstr("only this scene is read: the file has 2"));
}

TEST(GltfHierarchy, CyclesSharedChildrenAndLostNodesAreErrors) {
    const Json node = triangle_asset().json["nodes"][0];
    const Json below{{"children", {0u}}}, second{{"children", {2u}}}, first{{"children", {1u}}};
    expect_faults(triangle_asset(),
                  {{"/nodes/0/children", Json::array({0u}), "node 0"},
                   {"/nodes", Json::array({node, second, first}), "its own ancestor"},
                   {"/nodes", Json::array({node, below, below}), "also a child of node 1"},
                   {"/nodes/0/children", Json::array({9u}), "child node 9 does not exist"},
                   {"/nodes/0/mesh", 9u, "mesh 9 does not exist"},
                   {"/scene", 9u, "scene 9 does not exist"}});
}

TEST(GltfHierarchy, ChainOf100000NodesNeedsNoStack) {
    AssetBuilder asset = triangle_asset();
    constexpr unsigned kDepth = 100000;
    for (unsigned i = 1; i <= kDepth; ++i) {
        Json node = {{"children", {i + 1}}};
        if (i == kDepth) {
            node = {{"children", {0u}}};
        }
        asset.json["nodes"].push_back(node);
    }
    asset.json["scenes"][0]["nodes"] = {1u};
    EXPECT_EQ(must_import(asset).scene.primitives.size(), 1u);
}

TEST(GltfHierarchy, TooManyInstancedVerticesAreRefusedBeforeTheyAreMade) {
    AssetBuilder asset;
    const std::vector<float> many(3 * 100000, 0.0f);
    asset.add_node(asset.add_mesh({{"POSITION", asset.add<float>(many, "VEC3")}}));
    for (int i = 0; i < 3000; ++i) {
        asset.add_node(0);
    }
    const auto result = import_asset(asset);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::resource);
}

TEST(GltfHierarchy, SceneWithoutTrianglesIsAnError) {
    AssetBuilder bare = triangle_asset();
    bare.json["scenes"][0]["nodes"] = Json::array();
    expect_faults(bare, {{"/nodes", Json::array(), "the scene has no triangles"}});
    expect_faults(triangle_asset(),
                  {{"/scenes/0/nodes", Json::array(), "the scene has no triangles"},
                   {"/meshes/0/primitives/0/mode", 3u, "the scene has no triangles"},
                   {"/nodes/0/scale", {1, 0, 0}, "no triangle of the scene has an area"}});
}

TEST(GltfHierarchy, PositionsTooFarForRaysInSinglePrecisionAreErrors) {
    for (const double scale : {1e300, 1e30, 1e19, 1e13}) {
        AssetBuilder asset = triangle_asset();
        asset.json["nodes"][0]["scale"] = {scale, 1, 1};
        EXPECT_THAT(errors_of(import_asset(asset)), HasSubstr("too far away for single precision"))
            << scale;
    }
    AssetBuilder asset = triangle_asset();
    asset.json["nodes"][0]["scale"] = {1e11, 1, 1};
    EXPECT_TRUE(import_asset(asset).has_value());
}

TEST(GltfHierarchy, FlattenedNodesImportWithoutNan) {
    AssetBuilder asset = triangle_asset();
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    asset.json["nodes"][0]["scale"] = {0, 0, 0};
    asset.add_node(0);
    const auto imported = must_import(asset);
    EXPECT_THAT(imported.scene.primitives.at(0).normal, ::testing::Each(glm::vec3(0)));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("1 of 1 triangles have no area"));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("3 vertices have neither a normal nor a face"));
}

TEST(GltfHierarchy, WhatNodesCarryAndIsNotSimulatedIsNamed) {
    AssetBuilder asset = triangle_asset();
    asset.json["cameras"] = Json::array({{{"type", "perspective"}}});
    asset.json["nodes"][0]["camera"] = 0u;
    asset.json["nodes"][0]["extensions"]["VENDOR_sound"]["clip"] = 0u;
    asset.json["animations"] = Json::array({Json::object()});
    const std::string warnings = lines(must_import(asset).warnings);
    for (const char* word : {"animations", "'VENDOR_sound'", "cameras"}) {
        EXPECT_THAT(warnings, HasSubstr(word));
    }
}

/// A triangle at node 0, below node 1, which is moved by (1, 0, 0).
AssetBuilder triangle_below_a_parent() {
    AssetBuilder asset = triangle_asset();
    asset.json["nodes"][0]["translation"] = {0, 2, 0};
    asset.json["nodes"].push_back({{"children", {0u}}, {"translation", {1, 0, 0}}});
    return asset;
}

TEST(GltfHierarchy, NodeListedBesideAnAncestorStandsOnceByItsParent) {
    AssetBuilder asset = triangle_below_a_parent();
    asset.json["nodes"].push_back({{"children", {1u}}, {"translation", {0, 0, 4}}});
    for (const Json& list : {Json{1u, 0u}, Json{0u, 1u}, Json{0u, 2u}, Json{2u, 1u, 0u, 2u}}) {
        asset.json["scenes"][0]["nodes"] = list;
        const auto imported = must_import(asset);
        ASSERT_EQ(imported.scene.primitives.size(), 1u) << list;
        const bool from_above = list[1] == 2u || list[0] == 2u;
        EXPECT_EQ(imported.scene.primitives[0].position[0], glm::vec3(1, 2, from_above ? 4 : 0));
        EXPECT_THAT(lines(imported.warnings), HasSubstr("scene 0: it lists node 0 and a parent"));
    }
}

TEST(GltfHierarchy, ChildListedWithoutItsParentStandsAsIfItHadNone) {
    AssetBuilder asset = triangle_below_a_parent();
    asset.json["scenes"][0]["nodes"] = {0u};
    const auto imported = must_import(asset);
    ASSERT_EQ(imported.scene.primitives.size(), 1u);
    EXPECT_EQ(imported.scene.primitives[0].position[0], glm::vec3(0, 2, 0));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("node 0 without its parent"));
}

TEST(GltfHierarchy, NodeListedTwiceStandsOnce) {
    AssetBuilder asset = triangle_asset();
    asset.json["scenes"][0]["nodes"] = {0u, 0u};
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.primitives.size(), 1u);
    EXPECT_THAT(lines(imported.warnings), HasSubstr("lists a node twice"));
}

TEST(GltfHierarchy, EveryInstanceOfAMeshIsPlaced) {
    AssetBuilder asset = triangle_asset();
    asset.add_node(0);
    const float h = std::sqrt(0.5f);
    const auto translation = asset.add<float>({0, 0, 0, 5, 0, 0}, "VEC3");
    const auto rotation = asset.add<float>({0, 0, 0, 1, 0, 0, h, h}, "VEC4");
    const auto scale = asset.add<float>({1, 1, 1, 2, 3, 1}, "VEC3");
    Json& node = asset.json["nodes"][0];
    node["translation"] = {0, 0, 1};
    Json& instances = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    instances = {{"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}};
    asset.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const auto imported = must_import(asset);
    ASSERT_EQ(imported.scene.primitives.size(), 3u);
    EXPECT_EQ(imported.scene.primitives[0].position[1], glm::vec3(1, 0, 1));
    // Scaled first, then a quarter turn about z, then moved; then by the node.
    expect_near(imported.scene.primitives[1].position[1], {5, 2, 1}, 1e-6f);
    expect_near(imported.scene.primitives[1].position[2], {2, 0, 1}, 1e-6f);
    EXPECT_EQ(imported.scene.primitives[1].name, "node 0 > instance 1 > mesh 0 > primitive 0");
    EXPECT_THAT(lines(imported.warnings), testing::Not(HasSubstr("EXT_mesh_gpu_instancing")));

    instances["ROTATION"] =
        asset.add<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, "VEC4", true);
    instances.erase("SCALE");
    expect_near(must_import(asset).scene.primitives.at(1).position[1], {5, 1, 1}, 1e-4f);
    instances = {{"_ID", translation}};
    EXPECT_EQ(must_import(asset).scene.primitives.size(), 3u) << "two at the node's own place";
    instances = Json::object();
    EXPECT_EQ(must_import(asset).scene.primitives.size(), 2u) << "as without the extension";

    const auto one = asset.add<float>({1, 1, 1}, "VEC3"),
               zero = asset.add<float>({0, 0, 0, 0}, "VEC4");
    const char* const at = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    expect_faults(
        asset, {{at, {{"TRANSLATION", translation}, {"SCALE", one}}, "'TRANSLATION' has 2 values"},
                {at, {{"ROTATION", translation}}, "ROTATION has not 4"},
                {at, {{"ROTATION", zero}}, "not a unit quaternion"},
                {at, {{"TRANSLATION", 99u}}, "accessor 99 does not exist"},
                {at, {{"TRANSLATION", -1}}, "is not an accessor"}});
}

TEST(GltfHierarchy, MeshesThatAreOnlyMovedAreCopiesWhereTheyAreWanted) {
    AssetBuilder asset = triangle_asset();
    asset.add_node(0);
    asset.add_node(0);
    asset.add_node(0);
    asset.json["nodes"][1]["translation"] = {2, 0, -1};
    asset.json["nodes"][2]["scale"] = {2, 1, 1};
    asset.json["nodes"][3]["scale"] = {2, 1, 1};
    asset.json["nodes"][3]["translation"] = {0, 5, 0};
    const auto whole = must_import(asset).scene;
    const auto scene = must_import(asset, {.metres_per_unit = 0.5, .keep_copies = true}).scene;
    ASSERT_EQ(scene.primitives.size(), 4u);
    for (const std::size_t p : {1u, 3u}) {
        const formats::Primitive& copy = scene.primitives[p];
        ASSERT_TRUE(copy.is_copy());
        EXPECT_TRUE(copy.position.empty());
        EXPECT_EQ(copy.copy.primitive, p - 1);
        EXPECT_EQ(copy.name, whole.primitives[p].name);
        EXPECT_EQ(copy.node, p);
        for (std::size_t v = 0; v < 3; ++v) {
            EXPECT_EQ(scene.primitives[p - 1].position[v] + copy.copy.offset,
                      0.5f * whole.primitives[p].position[v]);
        }
        EXPECT_FALSE(scene.primitives[p - 1].is_copy());
        EXPECT_FALSE(whole.primitives[p].is_copy());
    }
    std::uint64_t counted = 0;
    const auto count = [&](const formats::SceneCounts& counts) {
        counted = counts.vertices;
        return formats::ok_status();
    };
    must_import(asset, {.check_size = count, .keep_copies = true});
    EXPECT_EQ(counted, 6u);
}

TEST(GltfHierarchy, TooManyInstancesAreRefusedBeforeTheyAreMade) {
    AssetBuilder asset = triangle_asset();
    asset.json["accessors"].push_back(
        {{"componentType", 5126u}, {"count", 4000000u}, {"type", "VEC3"}});
    asset.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        asset.json["accessors"].size() - 1;
    const auto result = import_asset(asset);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::resource);
}

}  // namespace
}  // namespace opaline::tests
