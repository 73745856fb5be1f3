#include <gmock/gmock.h>

#include <limits>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Bakes a file that cannot be baked: exit code 3, the file named, nothing written.
class BadScene : public ::testing::Test {
  protected:
    std::string refuse(const std::string& name) {
        const auto before = list_folder(folder_.path());
        const std::string scene = folder_ / name;
        const Outcome bake =
            run_opaline({"bake", scene, "-o", folder_ / "out.opal", "--report", folder_ / "r.json",
                         "--depfile", folder_ / "out.d", "--quality", "draft"});
        EXPECT_EQ(bake.exit_code, 3) << name << bake.err;
        EXPECT_THAT(bake.err, StartsWith("opaline: error: " + scene));
        EXPECT_EQ(bake.out, "");
        EXPECT_EQ(list_folder(folder_.path()), before);
        return bake.err;
    }
    std::string refuse_asset(const AssetBuilder& asset) {
        write_file(folder_ / "scene.glb", asset.glb());
        return refuse("scene.glb");
    }
    TemporaryFolder folder_;
};

TEST_F(BadScene, MissingFileIsNamed) {
    EXPECT_THAT(refuse("nowhere.glb"), HasSubstr("nowhere.glb"));
}

TEST_F(BadScene, EmptyFileIsRefused) {
    write_file(folder_ / "empty.glb", std::string());
    refuse("empty.glb");
    write_file(folder_ / "empty.gltf", std::string());
    refuse("empty.gltf");
}

TEST_F(BadScene, FolderInPlaceOfAFileIsRefused) {
    std::filesystem::create_directory(folder_ / "folder.glb");
    refuse("folder.glb");
}

TEST_F(BadScene, TruncatedGlbIsRefusedAtEveryTenthOfItsLength) {
    const Blob whole = two_squares().glb();
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
        write_file(folder_ / "cut.glb",
                   Blob(whole.begin(), whole.begin() + long(whole.size() * tenth / 10)));
        refuse("cut.glb");
    }
}

TEST_F(BadScene, FlippedBitsNeverCrashABake) {
    const Blob whole = two_squares().glb();
    const std::string scene = folder_ / "flipped.glb", out = folder_ / "out.opal";
    int refused = 0;
    for (std::size_t bit = 3; bit < whole.size() * 8; bit += whole.size() * 8 / 60) {
        Blob damaged = whole;
        damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
        write_file(scene, damaged);
        const Outcome bake = run_opaline({"bake", scene, "-o", out, "--quality", "draft"});
        ASSERT_TRUE(bake.exit_code == 0 || bake.exit_code == 3) << bit << bake.err;
        EXPECT_EQ(std::filesystem::exists(out), bake.exit_code == 0) << bit;
        if (bake.exit_code == 0) {
            EXPECT_EQ(run_opaline({"verify", out}).exit_code, 0) << bit;
            std::filesystem::remove(out);
        } else {
            EXPECT_THAT(bake.err, StartsWith("opaline: error: " + scene)) << bit;
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
}

TEST_F(BadScene, AccessorOutsideItsBufferIsNamed) {
    AssetBuilder asset = two_squares();
    asset.json["accessors"][0]["count"] = 5000;
    EXPECT_THAT(refuse_asset(asset), HasSubstr("accessor 0"));
    asset = two_squares();
    asset.json["accessors"][2]["byteOffset"] = 4294967295u;
    EXPECT_THAT(refuse_asset(asset), HasSubstr("accessor 2"));
    asset = two_squares();
    asset.json["bufferViews"][1]["byteLength"] = 1ull << 62;
    EXPECT_THAT(refuse_asset(asset), HasSubstr("bufferViews[1]"));
}

TEST_F(BadScene, IndexBeyondTheVerticesIsNamed) {
    AssetBuilder asset = two_squares();
    // The first index buffer follows twelve floats of positions.
    asset.bin[12 * 4 + 1] = 0x40;
    EXPECT_THAT(refuse_asset(asset), HasSubstr("primitive 0"));
}

TEST_F(BadScene, PositionsThatAreNoNumbersAreNamed) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        AssetBuilder asset = two_squares();
        std::memcpy(asset.bin.data() + 4 * 5, &bad, 4);
        EXPECT_THAT(refuse_asset(asset), HasSubstr("vertex 1"));
    }
}

TEST_F(BadScene, MeshOfZeroAreaTrianglesIsRefused) {
    AssetBuilder asset;
    const auto position = asset.add<float>({0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3");
    asset.add_node(asset.add_mesh({{"POSITION", position}}));
    EXPECT_THAT(refuse_asset(asset), HasSubstr("area"));
}

TEST_F(BadScene, SingleZeroAreaTriangleIsAWarning) {
    AssetBuilder asset = two_squares();
    const auto index = asset.add<std::uint16_t>({0, 1, 2, 0, 2, 3, 1, 1, 2}, "SCALAR");
    asset.json["meshes"][0]["primitives"][0]["indices"] = index;
    write_file(folder_ / "scene.glb", asset.glb());
    const Outcome bake = run_opaline(
        {"bake", folder_ / "scene.glb", "-o", folder_ / "out.opal", "--quality", "draft"});
    EXPECT_EQ(bake.exit_code, 0) << bake.err;
    EXPECT_THAT(bake.err, HasSubstr("1 of 3 triangles have no area"));
    EXPECT_EQ(run_opaline({"verify", folder_ / "out.opal"}).exit_code, 0);
}

TEST_F(BadScene, SceneWithoutTrianglesIsRefused) {
    AssetBuilder asset;
    EXPECT_THAT(refuse_asset(asset), HasSubstr("no triangles"));
    asset = triangle_asset();
    asset.json["nodes"] = Json::array();
    asset.json["scenes"][0]["nodes"] = Json::array();
    EXPECT_THAT(refuse_asset(asset), HasSubstr("no triangles"));
}

TEST_F(BadScene, MissingBufferIsNamed) {
    write_file(folder_ / "scene.gltf", two_squares().text_with_external_buffer());
    EXPECT_THAT(refuse("scene.gltf"), HasSubstr("buffer.bin"));
}

TEST_F(BadScene, MissingTextureIsNamed) {
    AssetBuilder asset = two_squares();
    const auto texcoord = asset.add<float>({0, 0, 0, 1, 1, 1, 1, 0}, "VEC2");
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = texcoord;
    asset.json["images"] = Json::array({{{"uri", "missing.png"}}});
    asset.json["textures"] = Json::array({{{"source", 0}}});
    asset.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    EXPECT_THAT(refuse_asset(asset), HasSubstr("missing.png"));
}

TEST_F(BadScene, FilesOutsideTheFolderAreRefused) {
    const TemporaryFolder elsewhere;
    AssetBuilder asset = two_squares();
    write_file(elsewhere / "secret.bin", asset.bin);
    Json json = Json::parse(asset.text());
    json["buffers"][0]["uri"] = "../" + elsewhere.path().filename().string() + "/secret.bin";
    write_file(folder_ / "scene.gltf", json.dump());
    EXPECT_THAT(refuse("scene.gltf"), HasSubstr("leaves the asset's folder"));
}

TEST_F(BadScene, UnknownRequiredExtensionIsNamed) {
    AssetBuilder asset = two_squares();
    asset.json["extensionsRequired"] = {"EXT_something_new"};
    asset.json["extensionsUsed"] = {"EXT_something_new"};
    EXPECT_THAT(refuse_asset(asset), HasSubstr("EXT_something_new"));
}

TEST_F(BadScene, NodeCycleIsRefused) {
    AssetBuilder asset = two_squares();
    asset.json["nodes"].push_back({{"children", {0u}}});
    asset.json["nodes"][0]["children"] = {1u};
    EXPECT_THAT(refuse_asset(asset), HasSubstr("node"));
}

TEST_F(BadScene, AnotherKindOfFileIsRefused) {
    write_file(folder_ / "model.obj", std::string("v 0 0 0\n"));
    refuse("model.obj");
    write_file(folder_ / "smoke.vdb", std::string("vdb"));
    EXPECT_THAT(refuse("smoke.vdb"), HasSubstr("OpenVDB"));
    write_file(folder_ / "text.gltf", std::string("hello"));
    refuse("text.gltf");
}

}  // namespace
}  // namespace opaline::tests
