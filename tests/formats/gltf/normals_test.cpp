#include <limits>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

/// The cube [-1,1]^3 as 12 triangles with 36 corners of their own, nothing shared.
std::vector<float> cube_soup() {
    std::vector<float> out;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            const float corner[6][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}};
            for (int i = 0; i < 6; ++i) {
                const auto& c = corner[side > 0 ? i : 5 - i];
                float p[3];
                p[axis] = side;
                p[(axis + 1) % 3] = c[0];
                p[(axis + 2) % 3] = c[1];
                out.insert(out.end(), p, p + 3);
            }
        }
    }
    return out;
}

TEST(GltfNormals, MissingNormalsOfACubeAreItsDiagonals) {
    // Three right angles meet at each corner whichever way the faces are cut, so that weights by
    // angle give exactly the diagonal; weights by face or by area would not.
    AssetBuilder asset;
    asset.add_node(asset.add_mesh({{"POSITION", asset.add<float>(cube_soup(), "VEC3")}}));
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    ASSERT_EQ(p.normal.size(), 36u);
    for (std::size_t v = 0; v < 36; ++v) {
        EXPECT_LT(glm::length(p.normal[v] - glm::normalize(p.position[v])), 1e-6f);
    }
    EXPECT_EQ(lines(imported.warnings), "");
}

TEST(GltfNormals, DuplicatedVerticesAndSplitPrimitivesShowNoSeam) {
    // A fold along x = 0, its two sides in primitives of their own.
    AssetBuilder asset;
    const auto left = asset.add<float>({0, 0, 0, 0, 1, 0, -1, 0, -1}, "VEC3");
    const auto right = asset.add<float>({0, 1, 0, 0, 0, 0, 1, 0, -1}, "VEC3");
    const auto mesh = asset.add_mesh({{"POSITION", left}});
    asset.json["meshes"][mesh]["primitives"].push_back({{"attributes", {{"POSITION", right}}}});
    asset.add_node(mesh);
    const auto imported = must_import(asset);
    const auto& a = imported.scene.primitives.at(0).normal;
    const auto& b = imported.scene.primitives.at(1).normal;
    EXPECT_EQ(a[0], b[1]);
    EXPECT_EQ(a[1], b[0]);
    EXPECT_NEAR(a[0].x, 0.0f, 1e-6f);  // by symmetry, up to rounding
    EXPECT_GT(a[0].z, 0.9f);
}

TEST(GltfNormals, BothSidesOfASheetKeepTheirOwnNormals) {
    AssetBuilder asset;
    const auto position =
        asset.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0}, "VEC3");
    asset.add_node(asset.add_mesh({{"POSITION", position}}));
    const auto imported = must_import(asset);
    const auto& normal = imported.scene.primitives.at(0).normal;
    for (int v = 0; v < 3; ++v) {
        EXPECT_EQ(normal[v], glm::vec3(0, 0, 1));
        EXPECT_EQ(normal[v + 3], glm::vec3(0, 0, -1));
    }
}

TEST(GltfNormals, NonManifoldFacesStillCount) {
    // Three walls on one edge, which no manifold has.
    AssetBuilder asset;
    const auto position =
        asset.add<float>({0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 0, 1, -1, 0, -1}, "VEC3");
    const auto index = asset.add<std::uint16_t>({0, 1, 2, 0, 1, 3, 0, 1, 4}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    ::testing::internal::CaptureStderr();
    const auto imported = must_import(asset);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");  // libraries never print
    for (const auto& normal : imported.scene.primitives.at(0).normal) {
        EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
    }
}

TEST(GltfNormals, NormalsWithoutDirectionAreRepairedAndCounted) {
    AssetBuilder asset = triangle_asset();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        asset.add<float>({0, 0, 0, nan, 0, 1, 0, 0, 2}, "VEC3");
    const auto imported = must_import(asset);
    EXPECT_THAT(imported.scene.primitives.at(0).normal, Each(glm::vec3(0, 0, 1)));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("2 values of NORMAL had no direction"));
}

TEST(GltfNormals, LooseVerticesGetNoNormalAndAreCounted) {
    AssetBuilder asset;
    const auto position = asset.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9}, "VEC3");
    const auto index = asset.add<std::uint32_t>({0, 1, 2}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    const auto imported = must_import(asset);
    const auto& p = imported.scene.primitives.at(0);
    EXPECT_EQ(p.position.size(), 4u);
    EXPECT_EQ(p.normal[3], glm::vec3(0));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("1 vertices have neither a normal nor a face"));
}

TEST(GltfNormals, ZeroAreaTrianglesStayAndDoNotSpoilNormals) {
    AssetBuilder asset;
    const auto position = asset.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const auto index = asset.add<std::uint16_t>({0, 1, 2, 0, 0, 1, 2, 2, 2}, "SCALAR");
    asset.add_node(asset.add_mesh({{"POSITION", position}}, {{"indices", index}}));
    const auto imported = must_import(asset);
    EXPECT_EQ(imported.scene.primitives.at(0).index.size(), 9u);
    EXPECT_THAT(imported.scene.primitives.at(0).normal, Each(glm::vec3(0, 0, 1)));
    EXPECT_THAT(lines(imported.warnings), HasSubstr("2 of 3 triangles have no area"));
}

}  // namespace
}  // namespace opaline::tests
