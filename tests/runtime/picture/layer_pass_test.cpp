#include "runtime/picture/layer_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/picture/software_renderer.h"
#include "tests/runtime/clouds/lit_layer.h"

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

}  // namespace
}  // namespace opaline::runtime
