#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/support/cloud_layers.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;
using test::Gl;

constexpr std::uint32_t kLayerLight = 8;

// Bumps with holes.
double bumps(std::uint32_t column, std::uint32_t row) {
    return 300 * std::max(0.0, std::sin(column * 0.41) * std::cos(row * 0.37) + 0.25) *
           (0.7 + 0.3 * std::sin(column * 1.9 + row * 2.3));
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
    test::TestVolume smoke = test::smoke_ball();
    smoke.sigma_t = {0.01f, 0.015f, 0.02f};
    smoke.albedo = {0.9f, 0.6f, 0.3f};
    for (const float low : {520.0f, 1100.0f}) {
        smoke.to_world = {20, 0, 0, -70, 0, 20, 0, low, 0, 0, 20, -820};
        test::add_volume(asset.volumes, smoke);
    }
    return asset;
}

const formats::Environment kLayerSky = tests::lat_long_map(64, 32, test::two_lights);

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
    return {.eye = place.eye,
            .target = place.target,
            .fov_y = place.fov_y,
            .width = 40,
            .height = 30,
            .near_plane = 1};
}

const std::array<LayerPlace, 6> kPlaces{{{"below", {0, 2, 0}, {0, 600, -900}},
                                         {"above", {0, 3000, 0}, {600, 1000, -1500}},
                                         {"grazing", {0, 1400, 0}, {3000, 1350, -1000}},
                                         {"glory", {0, 2500, 0}, {1000, 500, 1000}, 20},
                                         {"inside", {300, 1080, 200}, {900, 1100, -300}},
                                         {"horizon", {0, 200, 0}, {3000, 200, 100}, 40}}};

void expect_layer_agreement(const Asset& asset, const formats::Environment& sky,
                            std::span<const LayerPlace> places,
                            const GlRenderOptions& options = {}) {
    test::BothRenderers both(asset, sky);
    both.set_layers();
    for (const LayerPlace& place : places) {
        SCOPED_TRACE(place.name);
        both.expect_agreement(layer_camera(place), options);
    }
}

const formats::Clouds& broken_clouds() {
    static const formats::Clouds made = [] {
        formats::Clouds clouds = test::make_test_clouds(test::uneven_test_layer(48, 40), bumps);
        test::paint_squares(clouds, 180, 90);
        return clouds;
    }();
    return made;
}

const formats::Vec3 kToSun{-0.5f, 0.6f, -0.5f};

TEST_F(Gl, ABrokenLayerAgreesFromAllSides) {
    expect_layer_agreement(layer_alone(broken_clouds()), sun_from(kToSun), kPlaces);
}

TEST_F(Gl, AMeshPartlyBehindALayerAgrees) {
    const Asset asset = layer_and_sheet(broken_clouds());
    expect_layer_agreement(asset, sun_from(kToSun), std::span(kPlaces).first(2));
    expect_layer_agreement(asset, sun_from(kToSun), std::span(kPlaces).first(1),
                           {.supersampling = 1, .background = false});
}

TEST_F(Gl, SmokeBeforeInAndBehindALayerAgrees) {
    const Asset asset = layer_sheet_and_smoke(broken_clouds()),
                without = layer_and_sheet(broken_clouds());
    const std::array<LayerPlace, 4> places{{{"below", {0, 2, 0}, {200, 1000, -500}},
                                            {"above", {0, 3000, 0}, {250, 1200, -500}},
                                            {"grazing", {0, 1400, 600}, {250, 1250, -500}},
                                            {"inside", {-300, 1080, 200}, {250, 1100, -500}}}};
    test::BothRenderers smoke(asset, sun_from(kToSun)), none(without, sun_from(kToSun));
    smoke.set_layers();
    none.set_layers();
    for (const LayerPlace& place : places) {
        SCOPED_TRACE(place.name);
        const Camera camera = layer_camera(place);
        smoke.expect_agreement(camera);
        const Picture smoky = smoke.on_cpu(camera), clear = none.on_cpu(camera);
        int changed = 0;
        for (std::size_t i = 0; i < smoky.pixel.size(); ++i) {
            changed += std::abs(smoky.pixel[i].b / clear.pixel[i].b - 1) > 0.1f ? 1 : 0;
        }
        EXPECT_GT(changed, 40);
    }
}

TEST_F(Gl, LayersWithLessInThemAgree) {
    test::TestLayer layer = test::uneven_test_layer(48, 40);
    layer.record.flags = 0;
    layer.droplets.peak_angle = 0;
    layer.radiance = {0, 0, 0};
    const Asset bare = layer_alone(test::make_test_clouds(layer, bumps));
    // The sun is in the map; then there is none.
    expect_layer_agreement(bare, kLayerSky, std::span(kPlaces).first(3));
    const formats::Environment even = tests::lat_long_map(16, 8, [](formats::Vec3) {
        return Rgb{1, 0.8f, 0.5f};
    });
    expect_layer_agreement(bare, even, std::span(kPlaces).first(2));
}

TEST_F(Gl, TwoSunsAgree) {
    formats::Environment sky = sun_from(kToSun);
    sky.discs.push_back({formats::normalize({0.1f, 0.5f, -1}), 0.02f, {1e3f, 2e3f, 3e3f}});
    sky.discs.push_back({formats::normalize({0.3f, 0.7f, -1}), 0.02f, {10, 20, 30}});
    expect_layer_agreement(layer_alone(broken_clouds()), sky, std::span(kPlaces).first(2));
}

TEST_F(Gl, AnotherTimeMovesTheLayerAndTilesDoNot) {
    Asset asset = layer_alone(broken_clouds());
    asset.clouds.records[0].wind = {20, 5};
    test::BothRenderers both(asset, sun_from(kToSun));
    const std::size_t bytes = both.renderer.stats().gpu_bytes;
    both.set_layers();
    const std::size_t with_layer = both.renderer.stats().gpu_bytes;
    EXPECT_GT(with_layer, bytes);
    const Camera camera = layer_camera(kPlaces[1]);
    const Picture first = both.on_gl(camera);
    both.set_layers({.time = 100});
    EXPECT_EQ(both.renderer.stats().gpu_bytes, with_layer);
    const Picture moved = both.on_gl(camera);
    EXPECT_NE(first.pixel, moved.pixel);
    both.expect_agreement(camera);
    test::expect_same_picture(moved, both.on_gl(camera, {.max_tile_samples = 60}));
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
    test::BothRenderers both(asset, sun_from(kToSun));
    std::vector<Picture> pictures;
    for (const double time : {0.0, 40.0, 75.0}) {
        both.set_layers({.time = time});
        both.expect_agreement(layer_camera(kPlaces[1]));
        pictures.push_back(both.on_gl(layer_camera(kPlaces[1])));
    }
    EXPECT_NE(pictures[0].pixel, pictures[1].pixel);
    EXPECT_NE(pictures[1].pixel, pictures[2].pixel);
}

}  // namespace
}  // namespace opaline::runtime
