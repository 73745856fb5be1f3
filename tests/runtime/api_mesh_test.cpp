// Meshes, and the vertices that a baker added, through the C interface.
#include <gmock/gmock.h>

#include "tests/formats/opal/asset_fixture.h"
#include "tests/runtime/api_test_support.h"

namespace opaline::runtime {
namespace {

formats::Asset make_refined_asset() {
    formats::Asset asset = tests::make_small_asset();
    asset.added.count = {1, 2};
    asset.added.vertex = {{{0, 1, 2}, {0.5f, 0.5f}}, {{0, 1, 1}, {0.25f, 0}}, {{1, 0, 0}, {1, 0}}};
    return asset;
}

class ApiMesh : public testing::Test, protected tests::LoadedAsset {
  protected:
    ApiMesh() : LoadedAsset(make_refined_asset()) {}
};

TEST_F(ApiMesh, OfEachPrimitiveHasItsOwnVerticesAndThoseThatWereAdded) {
    opaline_primitive_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    ASSERT_EQ(opaline_asset_primitive_mesh(asset.get(), 1, &mesh), OPALINE_OK);
    EXPECT_EQ(mesh.position[3 * 3 + 2], 1);  // z of the last vertex
    EXPECT_EQ(mesh.normal[2], 1);
    EXPECT_EQ(mesh.texcoord[2 * 3], 1);
    EXPECT_EQ(mesh.base_color[1], 0.6f);
    ASSERT_EQ(mesh.index_count, 6u);
    EXPECT_EQ(mesh.index[4], 3u);
    ASSERT_EQ(mesh.added_count, 2u);
    EXPECT_EQ(mesh.added[0].corner[1], 1u);
    EXPECT_EQ(mesh.added[0].weight[0], 0.25f);
    EXPECT_EQ(mesh.added[1].weight[0], 1);
}

TEST_F(ApiMesh, WhatIsNotThereIsRefused) {
    opaline_primitive_mesh mesh{};
    EXPECT_EQ(opaline_asset_primitive_mesh(asset.get(), 0, &mesh), OPALINE_INVALID_ARGUMENT);
    mesh.struct_size = sizeof mesh;
    EXPECT_EQ(opaline_asset_primitive_mesh(asset.get(), 2, &mesh), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_asset_primitive_mesh(nullptr, 0, &mesh), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_asset_primitive_mesh(asset.get(), 0, nullptr), OPALINE_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace opaline::runtime
