#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/picture/layer_pass.h"
#include "runtime/picture/software_renderer.h"
#include "tests/runtime/clouds/lit_layer.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/lit_volumes.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

formats::Clouds pass_clouds(bool empty) {
    static const formats::Clouds kMade = [] {
        test::TestLayer layer = test::even_test_layer();
        layer.record.columns = layer.record.rows = 32;
        layer.radiance = {8, 6, 4};
        return test::make_test_clouds(layer, [](std::uint32_t column, std::uint32_t row) {
            return std::max(0.0, std::sin(0.4 * column) * std::cos(0.6 * row + 1)) * 100;
        });
    }();
    formats::Clouds clouds = kMade;
    if (empty) std::ranges::fill(clouds.thickness, std::uint16_t{0});
    return clouds;
}

Camera camera_toward(formats::Vec3 eye, formats::Vec3 direction) {
    return {.eye = eye,
            .target = eye + 100.0f * direction,
            .width = 96,
            .height = 72,
            .near_plane = 0.1f};
}

Picture draw(const test::LitLayer& lit, const Camera& camera, unsigned threads = 2,
             std::uint32_t supersampling = 3) {
    formats::Asset asset;
    asset.clouds = lit.clouds;
    SoftwareOptions options;
    options.layers = &lit.light;
    options.threads = threads;
    options.supersampling = supersampling;
    auto picture =
        render_software(asset.view(), {}, lit.environment, lit.rotation, camera, options);
    EXPECT_TRUE(picture);
    return std::move(picture).value();
}

TEST(LayerPass, WithoutCloudsTheSkyIsTheBackgroundAndItsSunHasItsFlux) {
    const test::LitLayer lit(pass_clouds(true), test::sunny_day(0.1f, 0.5, 0.2));
    const Camera up = camera_toward({0, 10, 0}, lit.light.sun.front().direction);
    const Picture seen = draw(lit, up);
    SoftwareOptions plain;
    const auto expected =
        render_software(formats::Asset{}.view(), {}, lit.environment, lit.rotation, up, plain);
    ASSERT_TRUE(expected);
    for (std::size_t i = 0; i < seen.pixel.size(); ++i) {
        EXPECT_NEAR(seen.pixel[i].g / expected->pixel[i].g, 1, 1e-5f) << i;
    }
}

TEST(LayerPass, SmoothPixelsAreWhatTheirSamplesAre) {
    const test::LitLayer lit(pass_clouds(false), test::sunny_day(0.1f, 0.5, 0.2));
    for (const auto& camera : {camera_toward({0, 0, 0}, test::direction_of(0.6, 2)),
                               camera_toward({0, 2000, 0}, test::direction_of(-0.3, 1)),
                               camera_toward({0, 0, 0}, test::direction_of(0.01, 2))}) {
        const Picture seen = draw(lit, camera);
        const LayerScene scene = lit.scene();
        const CameraFrame frame = camera_frame(camera);
        double sum = 0;
        int far_off = 0;
        for (std::uint32_t y = 0; y < camera.height; y += 3) {
            for (std::uint32_t x = 0; x < camera.width; x += 3) {
                double mean = 0;
                for (int k = 0; k < 64; ++k) {
                    LayerRay ray{camera.eye, view_ray(camera, frame, x + (k % 8 + 0.5) / 8,
                                                      y + (k / 8 + 0.5) / 8)};
                    ray.spread = static_cast<float>(2 * frame.tan_half_y / camera.height);
                    mean += static_cast<double>(see_through_layer(scene, ray).g) / 64;
                }
                const double is = static_cast<double>(seen.pixel[y * camera.width + x].g);
                far_off += std::abs(is - mean) > 0.25 * mean ? 1 : 0;
                sum += std::abs(is - mean) / mean;
            }
        }
        EXPECT_LT(far_off, 8);  // of 768: edges that nine samples see too little of
        EXPECT_LT(sum / (24 * 32), 0.015);
    }
}

TEST(LayerPass, SurfacesStayWhereTheyAreInFrontOfEverything) {
    const test::LitLayer lit(pass_clouds(false), test::sunny_day(0.1f, 0.5, 0.2));
    const Camera camera = camera_toward({0, 500, 0}, {0, -1, 0});
    Band band;
    reset_band(band, 0, 2, 2);
    std::ranges::fill(band.inverse_distance, 1.0 / 400);
    band.inverse_distance[3] = 1.0 / 600;  // beneath the ground
    const Rgb red{1, 0, 0};
    std::vector<Rgb> color(4, red);
    Camera small = camera;
    small.width = small.height = 2;
    draw_layers({lit.scene(), small, camera_frame(small), 1}, band, {color, {}});
    EXPECT_EQ(color[0], red);
    EXPECT_GT(color[3].g, 0);
}

using formats::Vec3;

// A cube of smoke of 64 m, its centre above the origin.
test::TestVolume cube_of_smoke(float height, float sigma_t) {
    test::TestVolume volume;
    volume.extent = {4, 4, 4};
    volume.to_world = {2, 0, 0, -31, 0, 2, 0, height - 31, 0, 0, 2, -31};
    volume.single_terms = 1;
    volume.sigma_t = {sigma_t, 1.5f * sigma_t, 2 * sigma_t};
    volume.albedo = {0.9f, 0.7f, 0.4f};
    return volume;
}

// The tables do not depend on the thickness.
formats::Clouds even_clouds(float thickness) {
    static const formats::Clouds kMade = [] {
        test::TestLayer layer = test::even_test_layer();
        layer.flux = {16, 10};
        layer.radiance = {8, 6, 2};
        return test::make_test_clouds(layer);
    }();
    formats::Clouds clouds = kMade;
    clouds.records[0].highest = thickness;
    return clouds;
}

formats::Environment sky_with_sun(Vec3 to_sun = {1, 0.5f, 0}) {
    formats::Environment sky = test::white_sky(0.1f);
    sky.discs.push_back({formats::normalize(to_sun), 0.005f, {2e4f, 1.5e4f, 1e4f}});
    return sky;
}

// One pixel from the ground straight up.
Camera pixel_upward() {
    return {.eye = {0, 2, 0},
            .target = {0, 1000, 0},
            .up = {1, 0, 0},
            .fov_y = 0.05f,
            .width = 1,
            .height = 1,
            .near_plane = 0.1f};
}

using Smoke = test::LitTestVolumes;

Picture draw_with(const test::LitLayer& lit, const Smoke* smoke, const Camera& camera,
                  unsigned threads = 1) {
    formats::Asset asset = test::make_asset(test::kSize, 16);
    asset.clouds = lit.clouds;
    SoftwareOptions options;
    options.layers = &lit.light;
    options.threads = threads;
    if (smoke != nullptr) {
        asset.volumes = smoke->volumes;
        options.volumes = &smoke->light;
    }
    auto picture =
        render_software(asset.view(), {}, lit.environment, lit.rotation, camera, options);
    EXPECT_TRUE(picture);
    return std::move(picture).value();
}

Rgb seen_upward(const test::LitLayer& lit, float height, float sigma_t) {
    const Smoke smoke({cube_of_smoke(height, sigma_t)});
    return draw_with(lit, &smoke, pixel_upward()).pixel[0];
}

void expect_close(Rgb is, Rgb expected, float tolerance) {
    EXPECT_NEAR(is.r / expected.r, 1, tolerance);
    EXPECT_NEAR(is.g / expected.g, 1, tolerance);
    EXPECT_NEAR(is.b / expected.b, 1, tolerance);
}

TEST(LayerAndVolumes, OpaqueSmokeBehindAThickLayerIsInvisible) {
    const test::LitLayer lit(even_clouds(1000), sky_with_sun());
    const Rgb alone = draw_with(lit, nullptr, pixel_upward()).pixel[0];
    ASSERT_GT(alone.g, 0);
    expect_close(seen_upward(lit, 2100, 1), alone, 1e-6f);
    expect_close(seen_upward(lit, 1700, 1), alone, 1e-6f);  // within it, farther than is seen
}

TEST(LayerAndVolumes, OpaqueSmokeInFrontHidesTheLayer) {
    const test::LitLayer lit(even_clouds(1000), sky_with_sun());
    const Smoke smoke({cube_of_smoke(500, 1)});
    expect_close(draw_with(lit, &smoke, pixel_upward()).pixel[0],
                 march_volumes(smoke.lit, {{0, 2, 0}, {0, 1, 0}}).radiance, 1e-6f);
}

// By the formulas of volume_pass.h, with the sky and perhaps a sun behind both.
void expect_composed_by_depth(const test::LitLayer& lit, Rgb sun) {
    const Vec3 eye{0, 2, 0}, up{0, 1, 0};
    const SeenLayer layer = see_layer(lit.light, {eye, up});
    ASSERT_GT(layer.transmittance.g, 0.2f);
    ASSERT_LT(layer.transmittance.g, 0.8f);
    const Rgb sky{0.1f, 0.1f, 0.1f};
    const Rgb behind = layer.glow + layer.transmittance * sky + layer.sun_transmittance * sun;
    const MarchResult smoke = march_volumes(Smoke({cube_of_smoke(500, 0.01f)}).lit, {eye, up});
    expect_close(seen_upward(lit, 500, 0.01f),
                 smoke.radiance + smoke.transmittance * (layer.radiance + behind), 1e-3f);
    expect_close(
        seen_upward(lit, 1500, 0.01f),
        layer.radiance + layer.transmittance * smoke.radiance + smoke.transmittance * behind,
        1e-3f);
}

TEST(LayerAndVolumes, ThinOnesAreComposedByDepth) {
    const test::LitLayer lit(even_clouds(15), sky_with_sun());
    expect_composed_by_depth(lit, {});
}

TEST(LayerAndVolumes, TheSunAndItsGlowAreDimmedByBoth) {
    const test::LitLayer lit(even_clouds(15), sky_with_sun({0, 1, 0}));
    expect_composed_by_depth(lit, lit.environment.discs[0].radiance);
}

TEST(LayerAndVolumes, NothingJumpsAsSmokeRisesThroughALayer) {
    const test::LitLayer lit(even_clouds(100), sky_with_sun());
    const Rgb first = seen_upward(lit, 900, 0.03f);
    Rgb before = first;
    float largest = 0, sum = 0;
    for (int metres = 902; metres <= 1200; metres += 2) {
        const Rgb now = seen_upward(lit, static_cast<float>(metres), 0.03f);
        largest = std::max(largest, std::abs(now.g - before.g));
        sum += now.g - before.g;
        before = now;
    }
    EXPECT_GT(std::abs(sum), 0.3f * first.g);   // it is seen before the layer, less behind it
    EXPECT_LT(largest, 0.09f * std::abs(sum));  // of 2 m, an optical depth of 0.09
}

TEST(LayerAndVolumes, TheGroundHidesSmokeBeneathIt) {
    const test::LitLayer lit(even_clouds(0), sky_with_sun());
    Camera down = pixel_upward();
    down.eye = {0, 500, 0};
    down.target = {0, 0, 0};
    const Rgb alone = draw_with(lit, nullptr, down).pixel[0];
    const Smoke under({cube_of_smoke(-40, 1)}), above({cube_of_smoke(100, 1)});
    expect_close(draw_with(lit, &under, down).pixel[0], alone, 1e-6f);
    EXPECT_GT(draw_with(lit, &above, down).pixel[0].g, 1.2f * alone.g);
}

TEST(LayerAndVolumes, HaveTheSameBitsForAnyNumberOfThreads) {
    const test::LitLayer lit(even_clouds(100), sky_with_sun());
    const Smoke smoke({cube_of_smoke(1030, 0.02f)});
    Camera camera = pixel_upward();
    camera.width = 16;
    camera.height = 40;
    camera.fov_y = 8;
    const Picture one = draw_with(lit, &smoke, camera, 1), five = draw_with(lit, &smoke, camera, 5);
    EXPECT_EQ(std::memcmp(one.pixel.data(), five.pixel.data(), one.pixel.size() * sizeof(Rgb)), 0);
}

}  // namespace

}  // namespace opaline::runtime
