#include <limits>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using formats::import_gltf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(GltfContainer, TextBinaryAndExternalBuffersGiveTheSameScene) {
    const AssetBuilder asset = triangle_asset();
    const TemporaryFolder folder;
    // Content decides, not the extension.
    write_file(folder / "binary.gltf", asset.glb());
    write_file(folder / "text.glb", asset.text());
    write_file(folder / "external.gltf", asset.text_with_external_buffer());
    write_file(folder / "buffer.bin", asset.bin);
    for (const char* name : {"binary.gltf", "text.glb", "external.gltf"}) {
        const auto result = import_gltf(folder / name);
        ASSERT_TRUE(result.has_value()) << name << "\n" << errors_of(result);
        ASSERT_EQ(result->scene.primitives.size(), 1u);
        const auto& primitive = result->scene.primitives[0];
        EXPECT_THAT(primitive.position,
                    ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
        EXPECT_THAT(primitive.index, ElementsAre(0u, 1u, 2u));
        EXPECT_EQ(result->scene.source, (folder / name).string());
    }
}

TEST(GltfContainer, InputsListEveryFileReadAndTheHashCoversTheirBytes) {
    const AssetBuilder asset = triangle_asset();
    const TemporaryFolder folder;
    write_file(folder / "a.gltf", asset.text_with_external_buffer());
    write_file(folder / "buffer.bin", asset.bin);
    const auto first = import_gltf(folder / "a.gltf");
    ASSERT_TRUE(first.has_value()) << errors_of(first);
    EXPECT_THAT(first->scene.inputs, ElementsAre(folder / "a.gltf", folder / "buffer.bin"));
    EXPECT_EQ(first->scene.sha256.size(), 64u);

    Blob changed = asset.bin;
    changed[0] ^= 1u;  // the lowest bit of one coordinate
    write_file(folder / "buffer.bin", changed);
    const auto second = import_gltf(folder / "a.gltf");
    ASSERT_TRUE(second.has_value()) << errors_of(second);
    EXPECT_NE(first->scene.sha256, second->scene.sha256);
}

TEST(GltfContainer, HashOfASingleFileIsItsSha256) {
    const auto result =
        import_text(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;ba)"
                    R"(se64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],"bufferViews")"
                    R"(:[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componen)"
                    R"(tType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attri)"
                    R"(butes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})");
    ASSERT_TRUE(result.has_value()) << errors_of(result);
    // From another program (coreutils' sha256sum) on the same bytes.
    EXPECT_EQ(result->scene.sha256,
              "ee910acacfb1abc50411694474811d839a99a950ae36236fc6e05674e4557917");
}

TEST(GltfContainer, PercentEncodedNamesInSubfoldersAreFound) {
    const AssetBuilder asset = triangle_asset();
    Json json = Json::parse(asset.text_with_external_buffer());
    json["buffers"][0]["uri"] = "parts/my%20buffer.bin";
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "parts");
    write_file(folder / "parts/my buffer.bin", asset.bin);
    write_file(folder / "a.gltf", json.dump());
    const auto result = import_gltf(folder / "a.gltf");
    EXPECT_TRUE(result.has_value()) << errors_of(result);
}

TEST(GltfContainer, UrisCannotLeaveTheFolder) {
    const AssetBuilder asset = triangle_asset();
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "asset");
    write_file(folder / "secret.bin", asset.bin);
    std::filesystem::create_symlink(folder / "secret.bin", folder / "asset/link.bin");
    const std::string absolute = (folder / "secret.bin").string();
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
          std::string("x/../../secret.bin"), absolute, "file://" + absolute,
          std::string("http://localhost/secret.bin"), std::string("..\\secret.bin"),
          std::string("link.bin"), std::string("a%00b"), std::string("%zz"), std::string("")}) {
        Json json = Json::parse(asset.text_with_external_buffer());
        json["buffers"][0]["uri"] = uri;
        write_file(folder / "asset/a.gltf", json.dump());
        const auto result = import_gltf(folder / "asset/a.gltf");
        ASSERT_FALSE(result.has_value()) << uri;
        EXPECT_EQ(result.error().kind, ErrorKind::bad_input);
        EXPECT_THAT(errors_of(result), HasSubstr("buffer 0: its URI")) << uri;
        const bool is_path = uri == "../secret.bin" || uri == "%2e%2e/secret.bin" ||
                             uri == absolute || uri == "link.bin";
        const auto allowed = import_gltf(folder / "asset/a.gltf", {1, {folder.path()}});
        EXPECT_EQ(allowed.has_value(), is_path) << uri << errors_of(allowed);
    }
}

TEST(GltfContainer, MissingAndShortBuffersAreNamed) {
    const AssetBuilder asset = triangle_asset();
    const auto missing = import_text(asset.text_with_external_buffer());
    EXPECT_THAT(errors_of(missing), HasSubstr("buffer 0 ('buffer.bin'): the file cannot be found"));

    const TemporaryFolder folder;
    write_file(folder / "a.gltf", asset.text_with_external_buffer());
    write_file(folder / "buffer.bin", Blob(asset.bin.begin(), asset.bin.end() - 1));
    EXPECT_THAT(errors_of(import_gltf(folder / "a.gltf")),
                HasSubstr("buffer 0: it has 35 bytes, but byteLength is 36"));
}

TEST(GltfContainer, OtherFilesAreRefused) {
    EXPECT_THAT(errors_of(import_text("")), HasSubstr("the file is empty"));
    EXPECT_THAT(errors_of(import_text("solid cube")), HasSubstr("this is not glTF"));
    EXPECT_THAT(errors_of(import_text("{}")), HasSubstr("asset.version is missing"));
    EXPECT_THAT(errors_of(import_text("{\"asset\": {\"version\": \"1.0\"}}")),
                HasSubstr("asset.version is '1.0', expected 2.x"));
    EXPECT_THAT(errors_of(import_text("{\"asset\": {\"version\": \"2.0\"}")),
                HasSubstr("cannot be parsed"));
}

TEST(GltfContainer, UnsupportedRequiredExtensionIsAnError) {
    AssetBuilder asset = triangle_asset();
    asset.json["extensionsRequired"] = {"KHR_materials_unlit"};
    EXPECT_THAT(errors_of(import_asset(asset)), HasSubstr("requires 'KHR_materials_unlit'"));
    asset.json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_texture_transform"};
    EXPECT_EQ(errors_of(import_asset(asset)), "");
}

TEST(GltfContainer, MetresPerUnitScalesPositions) {
    const auto imported = must_import(triangle_asset(), {0.01});
    EXPECT_EQ(imported.scene.primitives.at(0).position[1], glm::vec3(0.01f, 0, 0));
    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        const auto result = import_asset(triangle_asset(), {bad});
        ASSERT_FALSE(result.has_value());
        EXPECT_EQ(result.error().kind, ErrorKind::usage);
    }
}

}  // namespace
}  // namespace opaline::tests
