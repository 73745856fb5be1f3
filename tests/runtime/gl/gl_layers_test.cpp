#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "runtime/clouds/layer_light.h"
#include "runtime/gl/gl_renderer.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/support/cloud_layers.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;
using test::Gl;
using test::text_of;

constexpr std::uint32_t kLayerLight = 8;

// Bumps with holes.
double bumps(std::uint32_t column, std::uint32_t row) {
    return 300 * std::max(0.0, std::sin(column * 0.41) * std::cos(row * 0.37) + 0.25) *
           (0.7 + 0.3 * std::sin(column * 1.9 + row * 2.3));
}

formats::Clouds squares(formats::Clouds clouds) {
    for (std::size_t i = 0; i < clouds.ground.size(); ++i) {
        const auto code = static_cast<std::uint8_t>(i % 2 == 0 ? 180 : 90);
        clouds.ground[i] = {code, 120, static_cast<std::uint8_t>(255 - code), 255};
    }
    return clouds;
}

Asset layer_alone(formats::Clouds clouds) {
    Asset asset = test::make_asset(kLayerLight, 16);
    asset.clouds = std::move(clouds);
    return asset;
}

// With a steep sheet that stands partly in the layer.
Asset layer_and_sheet(formats::Clouds clouds) {
    Asset asset = layer_alone(std::move(clouds));
    test::add_primitive(asset,
                        test::make_sheet({-200, 700, -900}, {900, 100, 0}, {0, 900, -300}, 2, 2),
                        {.bands = 1, .details = 20});
    return asset;
}

// And two balls of smoke 560 m wide, partly in the layer and beneath or above it.
Asset layer_sheet_and_smoke(formats::Clouds clouds) {
    Asset asset = layer_and_sheet(std::move(clouds));
    asset.volumes = test::make_volumes(kLayerLight);
    test::TestVolume smoke;
    smoke.extent = {4, 4, 4};
    smoke.single_terms = 1;
    smoke.sigma_t = {0.01f, 0.015f, 0.02f};
    smoke.albedo = {0.9f, 0.6f, 0.3f};
    smoke.density = [](float x, float y, float z) {
        const float r2 = (x - 16) * (x - 16) + (y - 16) * (y - 16) + (z - 16) * (z - 16);
        return std::max(0.0f, 1 - r2 / 200);
    };
    for (const float low : {520.0f, 1100.0f}) {
        smoke.to_world = {20, 0, 0, -70, 0, 20, 0, low, 0, 0, 20, -820};
        test::add_volume(asset.volumes, smoke);
    }
    return asset;
}

const formats::Environment kLayerSky = test::make_lat_long(64, 32, test::two_lights);

formats::Environment sun_from(formats::Vec3 direction) {
    formats::Environment sky = kLayerSky;
    sky.discs.push_back({formats::normalize(direction), 0.01f, {4e4f, 3e4f, 1e4f}});
    return sky;
}

struct LayerPlace {
    const char* name;
    formats::Vec3 eye, target;
    float fov_y = 60;
};

Camera layer_camera(const LayerPlace& place) {
    Camera camera;
    camera.eye = place.eye;
    camera.target = place.target;
    camera.fov_y = place.fov_y;
    camera.width = 40;
    camera.height = 30;
    camera.near_plane = 1;
    return camera;
}

const std::array<LayerPlace, 6> kPlaces{{{"below", {0, 2, 0}, {0, 600, -900}},
                                         {"above", {0, 3000, 0}, {600, 1000, -1500}},
                                         {"grazing", {0, 1400, 0}, {3000, 1350, -1000}},
                                         {"glory", {0, 2500, 0}, {1000, 500, 1000}, 20},
                                         {"inside", {300, 1080, 200}, {900, 1100, -300}},
                                         {"horizon", {0, 200, 0}, {3000, 200, 100}, 40}}};

struct LitAsset {
    formats::Environment environment;
    Rotation rotation;
    LightVector vector;
    LayerLight layers;

    LitAsset(const Asset& asset, formats::Environment sky, const LayerLightOptions& options = {})
        : environment(std::move(sky)),
          vector(project_environment(environment, kLayerLight)),
          layers(light_layers(asset.view().clouds, environment, rotation, options)) {}
};

Picture draw_layer_on_cpu(const Asset& asset, const LitAsset& lit, const Camera& camera,
                          const GlRenderOptions& options) {
    formats::Vec3 eye = camera.eye;
    const auto radiance = shade_for_picture(asset.view(), lit.vector, eye, options.terms, 0);
    SoftwareOptions software;
    software.supersampling = options.supersampling;
    software.background = options.background;
    software.layers = &lit.layers;
    VolumeLight volumes;
    if (!asset.volumes.records.empty()) {
        volumes = relight_volumes(asset.view().volumes, lit.vector);
        software.volumes = &volumes;
    }
    auto picture =
        render_software(asset.view(), radiance, lit.environment, lit.rotation, camera, software);
    EXPECT_TRUE(picture.has_value());
    return std::move(picture).value();
}

void expect_layer_agreement(const Asset& asset, const LitAsset& lit,
                            std::span<const LayerPlace> places,
                            const GlRenderOptions& options = {}) {
    auto renderer = GlRenderer::create(asset.view(), lit.environment);
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light(lit.vector, lit.rotation));
    const auto shown = renderer->set_layers(lit.layers);
    ASSERT_TRUE(shown.has_value()) << text_of(shown.error());
    for (const LayerPlace& place : places) {
        SCOPED_TRACE(place.name);
        const Camera camera = layer_camera(place);
        const auto gl = renderer->render(camera, options);
        ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
        test::expect_same_picture(draw_layer_on_cpu(asset, lit, camera, options), *gl);
    }
}

const formats::Clouds& broken_clouds() {
    static const formats::Clouds clouds =
        squares(test::make_test_clouds(test::uneven_test_layer(48, 40), bumps));
    return clouds;
}

const formats::Vec3 kToSun{-0.5f, 0.6f, -0.5f};

TEST_F(Gl, ABrokenLayerAgreesFromAllSides) {
    const Asset asset = layer_alone(broken_clouds());
    expect_layer_agreement(asset, LitAsset(asset, sun_from(kToSun)), kPlaces);
}

TEST_F(Gl, AMeshPartlyBehindALayerAgrees) {
    const Asset asset = layer_and_sheet(broken_clouds());
    const LitAsset lit(asset, sun_from(kToSun));
    expect_layer_agreement(asset, lit, std::span(kPlaces).first(2));
    expect_layer_agreement(asset, lit, std::span(kPlaces).first(1),
                           {.supersampling = 1, .background = false});
}

TEST_F(Gl, SmokeBeforeInAndBehindALayerAgrees) {
    const Asset asset = layer_sheet_and_smoke(broken_clouds());
    const LitAsset lit(asset, sun_from(kToSun));
    const std::array<LayerPlace, 4> places{{{"below", {0, 2, 0}, {200, 1000, -500}},
                                            {"above", {0, 3000, 0}, {250, 1200, -500}},
                                            {"grazing", {0, 1400, 600}, {250, 1250, -500}},
                                            {"inside", {-300, 1080, 200}, {250, 1100, -500}}}};
    expect_layer_agreement(asset, lit, places);
    const Asset without = layer_and_sheet(broken_clouds());
    for (const LayerPlace& place : places) {
        const Camera camera = layer_camera(place);
        const Picture smoky = draw_layer_on_cpu(asset, lit, camera, {});
        const Picture clear = draw_layer_on_cpu(without, lit, camera, {});
        int changed = 0;
        for (std::size_t i = 0; i < smoky.pixel.size(); ++i) {
            changed += std::abs(smoky.pixel[i].b / clear.pixel[i].b - 1) > 0.1f ? 1 : 0;
        }
        EXPECT_GT(changed, 40) << place.name;
    }
}

TEST_F(Gl, LayersWithLessInThemAgree) {
    test::TestLayer layer = test::uneven_test_layer(48, 40);
    layer.record.flags = 0;
    layer.droplets.peak_angle = 0;
    layer.radiance = {0, 0, 0};
    const Asset bare = layer_alone(test::make_test_clouds(layer, bumps));
    // The sun is in the map; then there is none.
    expect_layer_agreement(bare, LitAsset(bare, kLayerSky), std::span(kPlaces).first(3));
    const formats::Environment even = test::make_lat_long(16, 8, [](formats::Vec3) {
        return Rgb{1, 0.8f, 0.5f};
    });
    expect_layer_agreement(bare, LitAsset(bare, even), std::span(kPlaces).first(2));
}

TEST_F(Gl, TwoSunsAgree) {
    const Asset asset = layer_alone(broken_clouds());
    formats::Environment sky = sun_from(kToSun);
    sky.discs.push_back({formats::normalize({0.1f, 0.5f, -1}), 0.02f, {1e3f, 2e3f, 3e3f}});
    sky.discs.push_back({formats::normalize({0.3f, 0.7f, -1}), 0.02f, {10, 20, 30}});
    expect_layer_agreement(asset, LitAsset(asset, sky), std::span(kPlaces).first(2));
}

TEST_F(Gl, AnotherTimeMovesTheLayerAndTilesDoNot) {
    Asset asset = layer_alone(broken_clouds());
    asset.clouds.records[0].wind = {20, 5};
    const LitAsset now(asset, sun_from(kToSun)), later(asset, sun_from(kToSun), {.time = 100});
    auto renderer = GlRenderer::create(asset.view(), now.environment);
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light(now.vector, now.rotation));
    const std::size_t bytes = renderer->stats().gpu_bytes;
    ASSERT_TRUE(renderer->set_layers(now.layers));
    const std::size_t with_layer = renderer->stats().gpu_bytes;
    EXPECT_GT(with_layer, bytes);
    const Camera camera = layer_camera(kPlaces[1]);
    const auto first = renderer->render(camera);
    ASSERT_TRUE(renderer->set_layers(later.layers));
    EXPECT_EQ(renderer->stats().gpu_bytes, with_layer);
    const auto moved = renderer->render(camera);
    const auto tiles = renderer->render(camera, {.max_tile_samples = 60});
    ASSERT_TRUE(first && moved && tiles);
    EXPECT_NE(first->pixel, moved->pixel);
    test::expect_same_picture(draw_layer_on_cpu(asset, later, camera, {}), *moved);
    test::expect_same_picture(*moved, *tiles);
}

TEST_F(Gl, AnotherTimeShowsABlendOfOtherFrames) {
    Asset asset = layer_alone(broken_clouds());
    formats::LayerRecord& record = asset.clouds.records[0];
    record.frames = 2;
    record.frame_seconds = 60;
    record.flags |= formats::LayerRecord::kLoop;
    std::vector<std::uint16_t>& codes = asset.clouds.thickness;
    const std::vector<std::uint16_t> first = codes;
    codes.insert(codes.end(), first.rbegin(), first.rend());
    const Camera camera = layer_camera(kPlaces[1]);
    std::optional<GlRenderer> renderer;
    std::vector<Picture> pictures;
    for (const double time : {0.0, 40.0, 75.0}) {
        const LitAsset lit(asset, sun_from(kToSun), {.time = time});
        if (!renderer) {
            auto made = GlRenderer::create(asset.view(), lit.environment);
            ASSERT_TRUE(made.has_value()) << text_of(made.error());
            renderer.emplace(std::move(*made));
            ASSERT_TRUE(renderer->set_light(lit.vector, lit.rotation));
        }
        ASSERT_TRUE(renderer->set_layers(lit.layers));
        auto picture = renderer->render(camera);
        ASSERT_TRUE(picture);
        test::expect_same_picture(draw_layer_on_cpu(asset, lit, camera, {}), *picture);
        pictures.push_back(std::move(*picture));
    }
    EXPECT_NE(pictures[0].pixel, pictures[1].pixel);
    EXPECT_NE(pictures[1].pixel, pictures[2].pixel);
}

}  // namespace
}  // namespace opaline::runtime
