#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using ::testing::HasSubstr;

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
