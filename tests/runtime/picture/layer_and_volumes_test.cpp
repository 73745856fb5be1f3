#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/picture/software_renderer.h"
#include "tests/runtime/clouds/lit_layer.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/lit_volumes.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
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
