// normalTexture and TANGENT of glTF files.

#include "tests/formats/gltf/asset_builder.h"
#include "tests/formats/gltf/encode_test_image.h"

namespace opaline::tests {
namespace {

using formats::Primitive;
using formats::TextureWrap;
using ::testing::HasSubstr;

/// A square in the plane z = 0, seen from +z, as two triangles; `u` and `v` of its corners (0, 0),
/// (1, 0), (1, 1), (0, 1).
AssetBuilder mapped_square(const std::vector<float>& texcoord,
                           Json normal_texture = {{"index", 0}}) {
    AssetBuilder asset;
    const auto mesh = asset.add_mesh(
        {{"POSITION", asset.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3")},
         {"TEXCOORD_0", asset.add<float>(texcoord, "VEC2")}},
        {{"indices", asset.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR")}, {"material", 0}});
    asset.add_node(mesh);
    asset.json["materials"] = Json::array({{{"name", "Brick"},
                                            {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                            {"normalTexture", std::move(normal_texture)}}});
    asset.json["samplers"] = Json::array({{{"wrapS", 33071}}});
    add_texture(asset, encode_png({128, 128, 255, 255, 200, 128, 230, 255}, 2, 1), Json::object(),
                {{"sampler", 0}});
    return asset;
}

const std::vector<float> kUpright = {0, 1, 1, 1, 1, 0, 0, 0};  // v = 0 on top

void expect_tangent(glm::vec4 found, glm::vec3 direction, float sign) {
    EXPECT_LT(glm::length(glm::vec3(found) - direction), 1e-6f);
    EXPECT_EQ(found.w, sign);
}

TEST(GltfNormalMap, IsReadWithItsScaleAndWrap) {
    const auto imported = must_import(mapped_square(kUpright, {{"index", 0}, {"scale", 0.5}}));
    const auto& material = imported.scene.materials.at(0);
    EXPECT_EQ(material.normal_image, 0u);
    EXPECT_EQ(material.normal_scale, 0.5f);
    EXPECT_EQ(material.normal_wrap_u, TextureWrap::clamp);
    EXPECT_EQ(material.normal_wrap_v, TextureWrap::repeat);
    ASSERT_EQ(imported.scene.images.size(), 1u);
    EXPECT_EQ(imported.scene.images[0].rgba[4], 200);
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfNormalMap, OfAThinWalledSurfaceIsReadLikeOthers) {
    AssetBuilder asset = mapped_square(kUpright);
    asset.json["extensionsUsed"] = {"KHR_materials_diffuse_transmission"};
    asset.json["materials"][0]["extensions"] = {
        {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.4}}}};
    const auto imported = must_import(asset);
    ASSERT_TRUE(imported.scene.materials.at(0).sheet);
    EXPECT_EQ(imported.scene.materials[0].normal_image, 0u);
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfNormalMap, TangentsFollowTheImageWhereTheFileHasNone) {
    const auto upright = must_import(mapped_square(kUpright));
    for (const glm::vec4 t : upright.scene.primitives.at(0).tangent) {
        expect_tangent(t, {1, 0, 0}, 1);  // up in the image is +y = cross(z, x)
    }
    const auto mirrored = must_import(mapped_square({1, 1, 0, 1, 0, 0, 1, 0}));
    for (const glm::vec4 t : mirrored.scene.primitives.at(0).tangent) {
        expect_tangent(t, {-1, 0, 0}, -1);
    }
    const auto turned = must_import(mapped_square({0, 0, 0, 1, 1, 1, 1, 0}));
    for (const glm::vec4 t : turned.scene.primitives.at(0).tangent) {
        expect_tangent(t, {0, 1, 0}, 1);
    }
    const auto one_point = must_import(mapped_square({0, 0, 0, 0, 0, 0, 0, 0}));
    for (const glm::vec4 t : one_point.scene.primitives.at(0).tangent) {
        EXPECT_EQ(t, glm::vec4(0));
    }
}

TEST(GltfNormalMap, TangentsOfTheFileAreTurnedWithItsNodes) {
    AssetBuilder asset = mapped_square(kUpright);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    // Slanted against the normal, of any length; the last one is missing.
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        asset.add<float>({0, 1, 1, 1, 0, 1, 0, -1, 0, 5, 0, 1, 0, 0, 0, 1}, "VEC4");
    asset.json["nodes"][0]["scale"] = {-1, 2, 1};
    const auto imported = must_import(asset);
    const Primitive& p = imported.scene.primitives.at(0);
    expect_tangent(p.tangent.at(0), {0, 1, 0}, -1);  // a mirror turns cross(N, T) round
    expect_tangent(p.tangent.at(1), {0, 1, 0}, 1);
    expect_tangent(p.tangent.at(2), {0, 1, 0}, -1);
    expect_tangent(p.tangent.at(3), {-1, 0, 0}, -1);  // from the image
}

TEST(GltfNormalMap, TangentsWithoutNormalsComeFromTheImage) {
    AssetBuilder asset = mapped_square(kUpright);
    const auto own = must_import(asset).scene.primitives.at(0).tangent;
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        asset.add<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4");
    EXPECT_EQ(must_import(asset).scene.primitives.at(0).tangent, own);
}

TEST(GltfNormalMap, OfATransformedImageFollowsTheTransform) {
    AssetBuilder asset = mapped_square(
        kUpright,
        {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {-1, 1}}}}}}});
    asset.json["extensionsUsed"] = {"KHR_texture_transform"};
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        asset.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    const auto imported = must_import(asset);
    for (const glm::vec4 t : imported.scene.primitives.at(0).tangent) {
        expect_tangent(t, {-1, 0, 0}, -1);
    }
}

TEST(GltfNormalMap, ThatIsMappedOtherwiseIsLeftOutWithAWarning) {
    AssetBuilder asset = mapped_square(kUpright, {{"index", 0}, {"texCoord", 1}});
    asset.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.materials.at(0).normal_image, formats::kNone);
    EXPECT_TRUE(imported.scene.primitives.at(0).tangent.empty());
    EXPECT_THAT(lines(imported.warnings), HasSubstr("normalTexture is mapped otherwise"));
}

TEST(GltfNormalMap, WithWrongTangentsOrLinksIsRefused) {
    AssetBuilder asset = mapped_square(kUpright);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        asset.add<float>({1, 0, 0, 1, 0, 0}, "VEC3");
    EXPECT_THAT(errors_of(import_asset(asset)), HasSubstr("TANGENT"));
    EXPECT_THAT(errors_of(import_asset(mapped_square(kUpright, {{"index", 7}}))),
                HasSubstr("texture"));
}

}  // namespace
}  // namespace opaline::tests
