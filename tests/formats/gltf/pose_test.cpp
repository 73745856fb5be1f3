#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A triangle at node 0, bound to two joints: node 1, moved by (0, 0, 4), and node 2, twice as
/// large. Vertex 0 follows the first, vertex 1 the second, vertex 2 both alike.
AssetBuilder bound_triangle() {
    AssetBuilder asset = triangle_asset();
    Json& attributes = asset.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = asset.add<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 9, 0}, "VEC4");
    attributes["WEIGHTS_0"] = asset.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4");
    asset.json["nodes"].push_back({{"translation", {0, 0, 4}}});
    asset.json["nodes"].push_back({{"scale", {2, 2, 2}}});
    asset.json["scenes"][0]["nodes"] = {0u, 1u, 2u};
    asset.json["skins"] = Json::array({{{"joints", {1u, 2u}}}});
    asset.json["nodes"][0]["skin"] = 0u;
    return asset;
}

TEST(GltfPose, JointsPlaceASkinnedMeshAndItsNodeDoesNot) {
    AssetBuilder asset = bound_triangle();
    asset.json["nodes"][0]["scale"] = {100, 100, 100};
    asset.json["nodes"][0]["translation"] = {7, 7, 7};
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    EXPECT_EQ(p.position[0], glm::vec3(0, 0, 4));
    EXPECT_EQ(p.position[1], glm::vec3(2, 0, 0));
    EXPECT_EQ(p.position[2], glm::vec3(0, 1.5f, 2));
    EXPECT_THAT(lines(imported.warnings), Not(HasSubstr("skin")));
}

TEST(GltfPose, InverseBindMatricesActBeforeJointsWhereverTheseStand) {
    AssetBuilder asset = bound_triangle();
    std::vector<float> matrices(32, 0.0f);
    for (std::size_t i = 0; i < 4; ++i) {
        matrices[5 * i] = matrices[16 + 5 * i] = 1;
    }
    matrices[14] = -4;  // the first joint stood where it stands now
    const std::size_t view = asset.add_view(matrices.data(), 4 * matrices.size());
    asset.json["skins"][0]["inverseBindMatrices"] = asset.add_accessor(view, 5126, 2, "MAT4");
    // Of a joint that the scene does not list, its own ancestors count.
    asset.json["nodes"].push_back({{"translation", {3, 0, 0}}, {"children", {1u}}});
    for (const Json& list : {Json{0u, 2u, 3u}, Json{0u}}) {
        asset.json["scenes"][0]["nodes"] = list;
        EXPECT_EQ(must_import(asset).scene.primitives.at(0).position[0], glm::vec3(3, 0, 0));
    }
}

TEST(GltfPose, NormalsFollowTheJoints) {
    AssetBuilder asset = bound_triangle();
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    asset.json["nodes"][1]["rotation"] = {1, 0, 0, 0};  // half a turn about x
    asset.json["nodes"][2]["rotation"] = {1, 0, 0, 0};
    const auto imported = must_import(asset);
    for (const glm::vec3 normal : imported.scene.primitives.at(0).normal) {
        EXPECT_LT(glm::length(normal - glm::vec3(0, 0, -1)), 1e-6f);
    }
}

TEST(GltfPose, MirroringJointsKeepFacesOutside) {
    AssetBuilder asset = bound_triangle();
    asset.json["nodes"][1]["scale"] = {1, 1, -1};
    asset.json["nodes"][2]["scale"] = {1, 1, -1};
    asset.json["nodes"][1].erase("translation");
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.primitives.at(0).normal[0], glm::vec3(0, 0, -1));
}

TEST(GltfPose, WeightsNeedNotAddUpToOne) {
    AssetBuilder asset = bound_triangle();
    asset.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        asset.add<std::uint8_t>({9, 0, 0, 0, 99, 0, 0, 0, 0, 0, 0, 0}, "VEC4", true);
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    EXPECT_EQ(p.position[0], glm::vec3(0, 0, 4));
    EXPECT_EQ(p.position[1], glm::vec3(2, 0, 0));
    EXPECT_EQ(p.position[2], glm::vec3(0, 1, 4));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("1 vertices have no weights"));
}

TEST(GltfPose, FaultsOfSkinsAreNamed) {
    AssetBuilder asset = bound_triangle();
    const auto negative = asset.add<float>({-1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    const std::string attributes = "/meshes/0/primitives/0/attributes";
    const std::string joints = attributes + "/JOINTS_0", weights = attributes + "/WEIGHTS_0";
    expect_faults(asset, {{"/nodes/0/skin", 3u, "skin 3 does not exist"},
                          {"/skins/0/joints", {1u, 77u}, "joint node 77 does not exist"},
                          {"/skins/0/joints", Json::array(), "joints is not a list of nodes"},
                          {"/skins/0/joints", Json::array({1u}),
                           "vertex 1 is bound to joint 1, but its skin has 1"},
                          {"/skins/0/inverseBindMatrices", 0u, "inverseBindMatrices are not MAT4"},
                          {weights, kErased, "only one of JOINTS_0 and WEIGHTS_0"},
                          {joints, asset.json[Json::json_pointer(weights)], "JOINTS_0 has FLOAT"},
                          {weights, negative, "weight of vertex 0 is negative"}});
}

TEST(GltfPose, APrimitiveWithoutJointsStandsByItsNode) {
    AssetBuilder asset = bound_triangle();
    asset.json["nodes"][0]["translation"] = {7, 0, 0};
    asset.json["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
    asset.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.primitives.at(0).position[0], glm::vec3(7, 0, 0));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("it has no JOINTS_0"));
}

/// Two morph targets: one raises vertex 1 by (0, 0, 2), the other moves all by (1, 0, 0).
AssetBuilder morphed_triangle() {
    AssetBuilder asset = triangle_asset();
    Json& primitive = asset.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = asset.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const auto raised = asset.add<float>({0, 0, 0, 0, 0, 2, 0, 0, 0}, "VEC3");
    const auto turned = asset.add<float>({1, 0, -1, 0, 0, 0, 0, 0, 0}, "VEC3");
    const auto moved = asset.add<std::int8_t>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    primitive["targets"] =
        Json::array({{{"POSITION", raised}, {"NORMAL", turned}}, {{"POSITION", moved}}});
    return asset;
}

TEST(GltfPose, DefaultWeightsOfMorphTargetsAreApplied) {
    AssetBuilder asset = morphed_triangle();
    EXPECT_EQ(must_import(asset).scene.primitives.at(0).position[1], glm::vec3(1, 0, 0));
    asset.json["meshes"][0]["weights"] = {0.5, 2};
    const auto by_mesh = must_import(asset);
    EXPECT_EQ(by_mesh.scene.primitives.at(0).position[1], glm::vec3(3, 0, 1));
    EXPECT_EQ(by_mesh.scene.primitives[0].position[0], glm::vec3(2, 0, 0));
    EXPECT_LT(
        glm::length(by_mesh.scene.primitives[0].normal[0] - glm::normalize(glm::vec3(1, 0, 1))),
        1e-6f);
    EXPECT_EQ(lines(by_mesh.warnings), "");
    asset.json["nodes"][0]["weights"] = {0, -1};  // the node's own count first
    EXPECT_EQ(must_import(asset).scene.primitives.at(0).position[1], glm::vec3(0, 0, 0));
}

TEST(GltfPose, FaultsOfMorphTargetsAreNamed) {
    AssetBuilder asset = morphed_triangle();
    asset.json["meshes"][0]["weights"] = {1, 1};
    const auto short_one = asset.add<float>({1, 0, 0}, "VEC3");
    const char* const target = "/meshes/0/primitives/0/targets/1";
    expect_faults(
        asset, {{target,
                 {{"POSITION", short_one}},
                 "morph target 1 POSITION has 1 values but POSITION has 3"},
                {target, {{"POSITION", 99u}}, "accessor 99 does not exist"},
                {target, {{"POSITION", "x"}}, "morph target 'POSITION' is"},
                {target, 1u, "targets is not an array of objects"},
                {"/meshes/0/weights", Json::array({"x"}), "weights is not an array of numbers"}});
}

}  // namespace
}  // namespace opaline::tests
