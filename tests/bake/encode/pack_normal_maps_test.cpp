#include "bake/encode/pack_asset.h"

#include <gtest/gtest.h>

#include "formats/opal/sheet_shares.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// Three sheets of two materials, of which the second has a normal map.
formats::Scene scene_with_normal_map() {
    formats::Scene scene = tests::make_scene({tests::make_quad({}, {1, 0, 0}, {0, 1, 0}),
                                              tests::make_quad({}, {1, 0, 0}, {0, 1, 0}),
                                              tests::make_quad({}, {1, 0, 0}, {0, 1, 0})});
    scene.images.resize(2);
    scene.materials.resize(2);
    scene.materials[1].normal_image = 1;
    scene.materials[1].normal_scale = 0.5f;
    scene.materials[1].normal_wrap_u = formats::TextureWrap::mirror;
    for (const std::size_t p : {0u, 2u}) {
        scene.primitives[p].material = 1;
    }
    scene.primitives[2].tangent.assign(4, {0, 1, 0, -1});
    return scene;
}

TEST(PackNormalMaps, PrimitivesWithTangentsHaveARecordAndAllVerticesATangent) {
    const formats::NormalMaps maps = pack_normal_maps(scene_with_normal_map());
    ASSERT_EQ(maps.record.size(), 1u);  // the first sheet has no coordinates
    EXPECT_EQ(maps.record[0].primitive, 2u);
    EXPECT_EQ(maps.record[0].image, 1u);
    EXPECT_EQ(maps.record[0].scale, 0.5f);
    EXPECT_EQ(maps.record[0].wrap_u, formats::Wrap::mirror);
    ASSERT_EQ(maps.tangent.size(), 12u);
    EXPECT_EQ(formats::decode_tangent(maps.tangent[3]).sign, 0);
    EXPECT_EQ(formats::decode_tangent(maps.tangent[8]).sign, -1);
    EXPECT_NEAR(formats::decode_tangent(maps.tangent[8]).direction.y, 1, 1e-6f);
}

TEST(PackNormalMaps, OfThinWalledSurfacesSayWhatTheseReflectAndTransmit) {
    formats::Scene scene = scene_with_normal_map();
    EXPECT_FALSE(formats::sheet_shares_of(pack_normal_maps(scene).record.at(0)).any());
    scene.materials[1].sheet =
        formats::Sheet{.reflect = {0.5f, 0.25f, 0}, .transmit = {0, 0.3f, 1}};
    const auto shares = formats::sheet_shares_of(pack_normal_maps(scene).record.at(0));
    EXPECT_EQ(shares.reflect, (formats::Rgb{0.5f, 0.25f, 0}));
    EXPECT_NEAR(shares.transmit.g, 0.3f, 0.3f / 2048);
    EXPECT_EQ(shares.transmit.b, 1);
}

TEST(PackNormalMaps, OnesThatChangeNothingAreLeftOut) {
    formats::Scene scene = scene_with_normal_map();
    scene.materials[1].normal_scale = 0;
    const formats::NormalMaps maps = pack_normal_maps(scene);
    EXPECT_TRUE(maps.record.empty());
    EXPECT_TRUE(maps.tangent.empty());
}

}  // namespace
}  // namespace opaline::bake
