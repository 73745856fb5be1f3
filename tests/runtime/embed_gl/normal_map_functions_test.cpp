// What is installed for hosts that draw normal maps, beside the CPU's normals and light.
#include <gtest/gtest.h>

#include "formats/opal/sheet_shares.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/runtime/embed_gl/gl_fixture.h"

namespace opaline::test {
namespace {

using formats::Asset;
using formats::Vec3;

class EmbedGlNormalMaps : public EmbedGl {};

constexpr formats::SheetShares kShares{{0.5f, 0.25f, 0.75f}, {0.25f, 0.5f, 0}};

Asset make_mapped() {
    Asset asset = make_asset(16, 8);
    asset.images.push_back(make_noise_image(7, 5));
    add_primitive(asset, make_sphere({}, 1, 5, 4), {});
    add_primitive(asset, make_sphere({3, 0, 0}, 1, 5, 4), {.eta = 1.3f});
    add_primitive(asset, make_sphere({6, 0, 0}, 1, 5, 4), {});
    add_normal_map(asset,
                   {.primitive = 0, .image = 0, .wrap_v = formats::Wrap::mirror, .scale = 0.7f},
                   {1, 0, 0}, -1);
    add_normal_map(asset, {.primitive = 1, .image = 0}, {1, 0, 0}, 1);
    add_primitive(asset, make_sheet({9, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 1), {.is_sheet = true});
    formats::NormalMapRecord map{.primitive = 3, .image = 0};
    formats::store_sheet_shares(kShares, map);
    add_normal_map(asset, map, {1, 0, 0}, 1);
    return asset;
}

opaline_gl_normal_map normal_map_of(const opaline_gl* gl, std::uint32_t primitive) {
    return filled<opaline_gl_normal_map>(opaline_gl_get_normal_map, gl, primitive);
}

TEST_P(EmbedGlNormalMaps, NormalsAndTurnedLightAreTheCpus) {
    make(make_mapped(), OPALINE_GL_WITH_IMAGES);
    EXPECT_EQ(normal_map_of(gl_, 0).harmonics[0][0], 0);
    const float sky[9][3] = {{2, 2, 3}, {1, 0.9f, 0.5f}, {0.2f, 0.1f, 0}};
    const float toward[3] = {0.3f, 0.8f, 0.5f}, radiance[3] = {9000, 8000, 7000};
    ASSERT_EQ(opaline_light_clear(host_->light()), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_harmonics(host_->light(), &sky[0][0]), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(host_->light(), toward, 0.01f, radiance), OPALINE_OK);
    relight();
    const opaline_gl_normal_map map = normal_map_of(gl_, 0);
    ASSERT_GE(map.suns, 1);
    EXPECT_EQ(map.is_turned, 1u);
    EXPECT_EQ(map.scale, 0.7f);
    EXPECT_EQ(normal_map_of(gl_, 3).is_turned, 2u);
    // The light that these numbers should be of.
    const Vec3 sun{map.sun_direction[0][0], map.sun_direction[0][1], map.sun_direction[0][2]};
    EXPECT_GT(dot(sun, formats::normalize({0.3f, 0.8f, 0.5f})), 0.999f);
    EXPECT_NEAR(map.harmonics[0][2] / map.harmonics[0][0], 1.5f, 0.05f);
    parity::Report report;
    parity::compare_normal_maps({*host_, GetParam(), gl_, report});
    EXPECT_TRUE(report.holds()) << report.text("normal maps", "");
}

TEST_P(EmbedGlNormalMaps, PrimitivesSayWhatTheyHaveAndWrongUseIsTold) {
    make(make_mapped(), OPALINE_GL_WITH_IMAGES);
    opaline_gl* without = nullptr;
    ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, &without), OPALINE_OK);
    EXPECT_EQ(normal_map_of(gl_, 0).image.wrap[1], 2);
    EXPECT_NE(normal_map_of(gl_, 0).tangent, 0u);
    EXPECT_EQ(normal_map_of(gl_, 1).is_turned, 0u);  // translucent
    EXPECT_NE(normal_map_of(gl_, 1).image.texture, 0u);
    EXPECT_EQ(normal_map_of(gl_, 2).image.texture, 0u);
    EXPECT_EQ(normal_map_of(without, 0).image.texture, 0u);
    opaline_gl_normal_map map{};
    EXPECT_EQ(opaline_gl_get_normal_map(gl_, 0, &map), OPALINE_INVALID_ARGUMENT);
    map.struct_size = sizeof map;
    EXPECT_THAT((Statuses{opaline_gl_get_normal_map(gl_, 4, &map),
                          opaline_gl_get_normal_map(nullptr, 0, &map),
                          opaline_gl_get_normal_map(gl_, 0, nullptr)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    EXPECT_EQ(opaline_gl_release(without), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlNormalMaps, kBothContexts, api_name);

}  // namespace
}  // namespace opaline::test
