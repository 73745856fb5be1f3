#include "bake/encode/pack_asset.h"

#include <gtest/gtest.h>

#include "bake/scene/marble.h"
#include "tests/support/scenes.h"

namespace opaline::tests {
namespace {

using formats::Asset;
using formats::Rgb;

Asset pack(const Scene& scene) {
    const std::vector<bake::RowLayout> layouts(scene.materials.size());
    formats::SparseRows rows = formats::make_sparse_rows(8, 8);
    for (const Primitive& primitive : scene.primitives) {
        formats::SparseRows part = formats::make_sparse_rows(8, 8);
        part.row_offset.resize(primitive.position.size() + 1);
        EXPECT_TRUE(formats::append_rows(rows, part));
    }
    return bake::pack_asset(scene, layouts, std::move(rows), {});
}

// Marble multiplies the base colour.
TEST(PackAsset, PositionsAndMarbleAreThoseOfTheWorld) {
    Scene scene = make_scene({make_sphere(1)});
    scene.materials[0].base_color = {0.5f, 1, 1};
    scene.materials[0].marble = {0.3f, {{0.1f, 0.2f, 0.3f}, {1, 0.9f, 0.8f}}};
    scene.origin = {1024, 0, -2048};
    const Asset asset = pack(scene);
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const glm::dvec3 world =
            glm::dvec3(1024, 0, -2048) + glm::dvec3(scene.primitives[0].position[v]);
        EXPECT_EQ(asset.position[v].x, static_cast<float>(world.x));
        EXPECT_EQ(asset.position[v].z, static_cast<float>(world.z));
        EXPECT_EQ(asset.base_color[v],
                  (Rgb{0.5f, 1, 1} * bake::marble_color(*scene.materials[0].marble, world)));
    }
    EXPECT_NE(asset.base_color[0], asset.base_color[5]);
}

TEST(PackAsset, OnlyPrimitivesWithAnImageStoreTextureCoordinates) {
    Scene scene =
        make_scene({make_quad({}, {1, 0, 0}, {0, 1, 0}), make_quad({}, {1, 0, 0}, {0, 1, 0})});
    for (Primitive& p : scene.primitives) {
        p.texcoord.assign(p.position.size(), {0.25f, 0.5f});
    }
    EXPECT_TRUE(pack(scene).texcoord.empty());

    scene.images.push_back({1, 1, {1, 2, 3, 255}});
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].base_color_image = 0;
    scene.primitives[1].material = 1;
    const Asset asset = pack(scene);
    ASSERT_EQ(asset.texcoord.size(), 8u);
    EXPECT_EQ(asset.texcoord[0].x, 0);
    EXPECT_EQ(asset.texcoord[4].x, 0.25f);
    EXPECT_EQ(asset.primitives[0].base_color_image, formats::kNoImage);
    EXPECT_EQ(asset.primitives[1].base_color_image, 0u);
}

TEST(PackAsset, APrimitiveThatOnlyGlowsByAnImageStoresTextureCoordinatesToo) {
    Scene scene = make_scene({make_quad({}, {1, 0, 0}, {0, 1, 0})});
    scene.primitives[0].texcoord.assign(4, {0.25f, 0.5f});
    scene.images.push_back({1, 1, {1, 2, 3, 255}});
    scene.materials[0].emission_image = 0;
    EXPECT_EQ(pack(scene).texcoord[2].x, 0.25f);
}

}  // namespace
}  // namespace opaline::tests
