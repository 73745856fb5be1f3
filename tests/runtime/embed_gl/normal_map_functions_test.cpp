// What is installed for hosts that draw normal maps, beside the CPU's normals and light.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "formats/opal/sheet_shares.h"
#include "runtime/normal_maps/normal_map.h"
#include "runtime/normal_maps/turned_light.h"
#include "tests/runtime/embed_gl/embedded_asset.h"
#include "tests/runtime/embed_gl/gl_fixture.h"
#include "tests/runtime/embed_gl/host/host_images.h"

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
    const Asset asset = make_mapped();
    const EmbeddedAsset host(asset);
    opaline_gl* gl = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, OPALINE_GL_WITH_IMAGES, &gl), OPALINE_OK)
        << opaline_last_error();
    EXPECT_EQ(normal_map_of(gl, 0).harmonics[0][0], 0);
    opaline_light* light = nullptr;
    ASSERT_EQ(opaline_light_create(host.asset(), &light), OPALINE_OK);
    const float sky[9][3] = {{2, 2, 3}, {1, 0.9f, 0.5f}, {0.2f, 0.1f, 0}};
    ASSERT_EQ(opaline_light_set_harmonics(light, &sky[0][0]), OPALINE_OK) << opaline_last_error();
    const float toward[3] = {0.3f, 0.8f, 0.5f}, radiance[3] = {9000, 8000, 7000};
    ASSERT_EQ(opaline_light_add_sun(light, toward, 0.01f, radiance), OPALINE_OK);
    ASSERT_EQ(opaline_gl_relight(gl, light), OPALINE_OK) << opaline_last_error();
    const opaline_gl_normal_map map = normal_map_of(gl, 0);
    ASSERT_GE(map.suns, 1);
    EXPECT_EQ(map.is_turned, 1u);
    EXPECT_EQ(map.scale, 0.7f);

    runtime::TurnedLight turned;
    for (std::size_t k = 0; k < 9; ++k) {
        turned.harmonics[k] = {map.harmonics[k][0], map.harmonics[k][1], map.harmonics[k][2]};
    }
    turned.least = {map.least[0], map.least[1], map.least[2]};
    for (int i = 0; i < map.suns; ++i) {
        const auto& d = map.sun_direction[i];
        const auto& c = map.sun_light[i];
        turned.suns.push_back({{d[0], d[1], d[2]}, {c[0], c[1], c[2]}});
    }
    // The light that these numbers should be of.
    EXPECT_GT(dot(turned.suns[0].direction, formats::normalize({0.3f, 0.8f, 0.5f})), 0.999f);
    EXPECT_NEAR(turned.harmonics[0].b / turned.harmonics[0].r, 1.5f, 0.05f);

    // The thin-walled primitive's are made of the same light.
    const opaline_gl_normal_map sheet = normal_map_of(gl, 3);
    EXPECT_EQ(sheet.is_turned, 2u);
    const runtime::TurnedLight two_sided = runtime::turned_light_of_sheet(turned, kShares);
    ASSERT_EQ(static_cast<std::size_t>(sheet.suns), two_sided.suns.size());
    EXPECT_EQ(sheet.sun_light[sheet.suns - 1][1], two_sided.suns.back().light.g);
    EXPECT_EQ(sheet.harmonics[1][2], two_sided.harmonics[1].b);
    EXPECT_EQ(sheet.least[0], two_sided.least.r);

    HostPicture picture = make_normal_map_picture(GetParam(), map);
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> value(-2, 2), share(0, 3);
    std::vector<HostRay> samples;
    for (int i = 0; i < 300; ++i) {
        const Vec3 n = formats::normalize({value(generator), value(generator), value(generator)});
        samples.push_back(
            {{value(generator), value(generator), 0}, share(generator), {n.x, n.y, n.z}, 0});
    }
    const std::vector<float> drawn = picture.draw(samples);
    const formats::AssetView view = asset.view();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto& d = samples[i].direction;
        const Vec3 n{d[0], d[1], d[2]};
        const Vec3 mapped =
            runtime::mapped_normal(view, view.normal_maps.record[0],
                                   {samples[i].from[0], samples[i].from[1]}, n, host_tangent(n));
        EXPECT_NEAR(drawn[8 * i], mapped.x, 1e-5f);
        EXPECT_NEAR(drawn[8 * i + 1], mapped.y, 1e-5f);
        const float x = samples[i].begin;
        const formats::Rgb lit = runtime::turn_light(turned, {x, 0.9f * x, 0.8f * x}, n, mapped);
        EXPECT_NEAR(drawn[8 * i + 4], lit.r, 1e-5f * (1 + lit.r)) << i;
        EXPECT_NEAR(drawn[8 * i + 6], lit.b, 1e-5f * (1 + lit.b)) << i;
    }
    opaline_light_release(light);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlNormalMaps, PrimitivesSayWhatTheyHaveAndWrongUseIsTold) {
    const EmbeddedAsset host(make_mapped());
    opaline_gl *gl = nullptr, *without = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, OPALINE_GL_WITH_IMAGES, &gl), OPALINE_OK);
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, 0, &without), OPALINE_OK);
    EXPECT_EQ(normal_map_of(gl, 0).image.wrap[1], 2);
    EXPECT_NE(normal_map_of(gl, 0).tangent, 0u);
    EXPECT_EQ(normal_map_of(gl, 1).is_turned, 0u);  // translucent
    EXPECT_NE(normal_map_of(gl, 1).image.texture, 0u);
    EXPECT_EQ(normal_map_of(gl, 2).image.texture, 0u);
    EXPECT_EQ(normal_map_of(without, 0).image.texture, 0u);
    opaline_gl_normal_map map{};
    EXPECT_EQ(opaline_gl_get_normal_map(gl, 0, &map), OPALINE_INVALID_ARGUMENT);
    map.struct_size = sizeof map;
    EXPECT_EQ(opaline_gl_get_normal_map(gl, 4, &map), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_normal_map(nullptr, 0, &map), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_normal_map(gl, 0, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(without), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlNormalMaps,
                         testing::Values(HostApi::desktop_43, HostApi::es_31), api_name);

}  // namespace
}  // namespace opaline::test
