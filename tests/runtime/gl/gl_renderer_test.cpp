#include "runtime/gl/gl_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::AssetView;
using formats::Environment;
using formats::Rgb;
using test::expect_same_picture;
using test::expect_same_radiance;
using test::Gl;
using test::text_of;

struct Variant {
    std::uint32_t n, code_bits, bands, details;
};

// Sphere (grey or RGB rows), floor (grey rows) and a textured board (three wraps of it).
Asset make_scene(const Variant& variant) {
    const bool is_large = variant.n > 32;  // rows of 98 304 coefficients: fewer of them
    Asset asset = test::make_asset(variant.n, variant.code_bits);
    asset.images.push_back(test::make_noise_image(13, 9));
    const auto sphere =
        is_large ? test::make_sphere({0, 1, 0}, 1, 8, 6) : test::make_sphere({0, 1, 0}, 1, 32, 20);
    test::add_primitive(asset, sphere, {.bands = variant.bands, .details = variant.details});
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1),
                        {.bands = 1, .details = variant.details});
    const formats::Wrap wraps[3] = {formats::Wrap::repeat, formats::Wrap::clamp,
                                    formats::Wrap::mirror};
    for (int i = 0; i < (is_large ? 1 : 3); ++i) {
        test::add_primitive(asset,
                            test::make_sheet({-2.2f + static_cast<float>(i), 0.6f, -1.5f},
                                             {0.45f, 0, 0.1f}, {0, -0.5f, 0}, 2, 1.8f),
                            {.bands = variant.bands,
                             .details = variant.details,
                             .image = 0,
                             .wrap_u = wraps[i],
                             .wrap_v = wraps[(i + 1) % 3]});
    }
    return asset;
}

std::vector<Rgb> radiance_on_cpu(const AssetView& asset, const LightVector& light) {
    std::vector<Rgb> radiance(asset.receivers());
    ShadeOptions options;
    options.base_color = false;
    shade(asset, light, radiance, options);
    return radiance;
}

TEST_F(Gl, DotProductsAndPicturesAgreeWithTheCpuForEveryKindOfRow) {
    const Environment sky = test::make_lat_long(128, 64, test::two_lights);
    const Rotation rotation = rotation_about_y(0.7f);
    for (const Variant& variant :
         {Variant{16, 8, 1, 100}, Variant{16, 8, 3, 60}, Variant{16, 16, 1, 200},
          Variant{8, 16, 3, 33}, Variant{128, 8, 3, 150}, Variant{128, 16, 1, 150}}) {
        SCOPED_TRACE(testing::Message() << "n " << variant.n << ", " << variant.code_bits
                                        << " bits, " << variant.bands << " bands");
        const Asset asset = make_scene(variant);
        const AssetView view = asset.view();
        const LightVector light = project_environment(sky, variant.n, rotation);
        const std::vector<Rgb> radiance = radiance_on_cpu(view, light);

        auto renderer = GlRenderer::create(view, sky);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        ASSERT_TRUE(renderer->set_light(light, rotation));
        const auto on_gl = renderer->read_radiance();
        ASSERT_TRUE(on_gl.has_value());
        expect_same_radiance(radiance, *on_gl);

        const Camera camera = frame_asset(view, 45, 240, 180);
        const auto cpu = render_software(view, radiance, sky, rotation, camera);
        const auto gl = renderer->render(camera);
        ASSERT_TRUE(cpu.has_value());
        ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
        expect_same_picture(*cpu, *gl);
    }
}

TEST_F(Gl, ResultDoesNotDependOnLanesBlocksOrTiles) {
    const Environment sky = test::make_lat_long(64, 32, test::two_lights);
    const Asset asset = make_scene({16, 8, 3, 77});
    const AssetView view = asset.view();
    const LightVector light = project_environment(sky, 16);
    const std::vector<Rgb> radiance = radiance_on_cpu(view, light);
    const Camera camera = frame_asset(view, 45, 101, 67);
    Picture first;
    for (const GlOptions& options : {GlOptions{1, 0}, GlOptions{4, 0}, GlOptions{16, 0},
                                     GlOptions{32, 0}, GlOptions{1, 4096}, GlOptions{16, 8192}}) {
        SCOPED_TRACE(testing::Message()
                     << options.lanes_per_row << " lanes, " << options.max_block_bytes << " bytes");
        auto renderer = GlRenderer::create(view, sky, options);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        EXPECT_EQ(renderer->stats().lanes_per_row, options.lanes_per_row);
        EXPECT_EQ(renderer->stats().dispatches > view.primitives.size(),
                  options.max_block_bytes != 0);
        ASSERT_TRUE(renderer->set_light(light, {}));
        const auto on_gl = renderer->read_radiance();
        ASSERT_TRUE(on_gl.has_value());
        expect_same_radiance(radiance, *on_gl);
        for (const std::uint32_t tile : {2048u, 96u, 1u}) {
            if (tile == 1 && !first.pixel.empty()) continue;  // a pixel at a time: once is enough
            const auto picture = renderer->render(camera, {3, tile});
            ASSERT_TRUE(picture.has_value()) << text_of(picture.error());
            if (first.pixel.empty()) first = *picture;
            expect_same_picture(first, *picture);
        }
    }
}

TEST_F(Gl, PrimitivesHaveLightsOfTheirOwn) {
    const Environment sky = test::make_lat_long(64, 32, test::two_lights);
    const Asset asset = make_scene({16, 8, 3, 77});
    const AssetView view = asset.view();
    const std::vector<LightVector> light{project_environment(sky, 16),
                                         project_environment(sky, 16, rotation_about_y(2))};
    const std::vector<std::uint32_t> of_primitive{1, 0, 1, 1, 0};
    std::vector<Rgb> radiance(asset.position.size());
    shade(view, {light, of_primitive, 0}, radiance, {.base_color = false});
    EXPECT_NE(radiance, radiance_on_cpu(view, light[0]));
    auto renderer = GlRenderer::create(view, sky);
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light({light, of_primitive, 0}, {}));
    const auto on_gl = renderer->read_radiance();
    ASSERT_TRUE(on_gl.has_value());
    expect_same_radiance(radiance, *on_gl);
    EXPECT_FALSE(renderer->set_light({light, std::span(of_primitive).first(4), 0}, {}));
    EXPECT_FALSE(renderer->set_light({std::span(light).first(1), of_primitive, 0}, {}));
    EXPECT_FALSE(renderer->set_light({light, of_primitive, 2}, {}));
}

TEST_F(Gl, BackgroundAgreesForEveryLayoutAndRotation) {
    Environment poles = test::make_lat_long(64, 33, test::two_lights);
    poles.rows_include_poles = true;
    poles.u_offset = 0.1f;
    poles.u_sign = -1;
    poles.discs.push_back({normalize(formats::Vec3{0.3f, 0.4f, -0.8f}), 0.05f, {20, 10, 5}});
    Environment discs_alone;
    discs_alone.discs = {{{0, 0, -1}, 0.2f, {1, 2, 3}},
                         {normalize(formats::Vec3{0.1f, 0, -1}), 0.2f, {3, 2, 1}}};
    const Rotation tilted{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    for (const Environment& sky : {poles, discs_alone, test::make_cube(16, test::two_lights)}) {
        auto renderer = GlRenderer::create(Asset{}.view(), sky);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        for (const Rotation& rotation : {Rotation{}, rotation_about_y(2.0f), tilted}) {
            LightVector nothing;
            ASSERT_TRUE(renderer->set_light(nothing, rotation));
            for (const formats::Vec3 target :
                 {formats::Vec3{0, 0, -1}, formats::Vec3{-1, 1, 1}, formats::Vec3{0, -1, 0.1f}}) {
                Camera camera;
                camera.eye = {0, 0, 0};
                camera.target = target;
                camera.fov_y = 100;
                camera.width = 160;
                camera.height = 120;
                const auto cpu = render_software(Asset{}.view(), {}, sky, rotation, camera);
                const auto gl = renderer->render(camera);
                ASSERT_TRUE(cpu && gl);
                if (std::ranges::none_of(cpu->pixel, [](Rgb c) { return luminance(c) > 0; })) {
                    continue;
                }
                expect_same_picture(*cpu, *gl);
            }
        }
    }
}

TEST_F(Gl, CameraInsideTheMeshAgrees) {
    const Environment sky = test::make_lat_long(64, 32, test::two_lights);
    const Asset asset = make_scene({16, 8, 1, 50});
    const LightVector light = project_environment(sky, 16);
    auto renderer = GlRenderer::create(asset.view(), sky);
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light(light, {}));
    Camera camera;
    camera.eye = {0.2f, 0.9f, 0.3f};
    camera.target = {-3, 0.2f, -2};
    camera.width = 150;
    camera.height = 110;
    camera.fov_y = 90;
    for (const float near_plane : {1e-3f, 1.0f}) {  // in front of the wall and cutting through it
        camera.near_plane = near_plane;
        const auto cpu =
            render_software(asset.view(), radiance_on_cpu(asset.view(), light), sky, {}, camera);
        const auto gl = renderer->render(camera);
        ASSERT_TRUE(cpu && gl);
        expect_same_picture(*cpu, *gl);
    }
}

TEST_F(Gl, OnePixelAndExtremeScalesAgree) {
    const Environment sky = test::make_lat_long(64, 32, test::two_lights);
    for (const float scale : {1e-12f, 1.0f, 1e12f}) {
        Asset asset = make_scene({8, 8, 1, 20});
        for (formats::Vec3& p : asset.position) {
            p = scale * p;
        }
        const LightVector light = project_environment(sky, 8);
        auto renderer = GlRenderer::create(asset.view(), sky);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        ASSERT_TRUE(renderer->set_light(light, {}));
        for (const std::uint32_t size : {1u, 120u}) {
            const Camera camera = frame_asset(asset.view(), 40, size, size);
            const auto cpu = render_software(asset.view(), radiance_on_cpu(asset.view(), light),
                                             sky, {}, camera);
            const auto gl = renderer->render(camera);
            ASSERT_TRUE(cpu && gl);
            expect_same_picture(*cpu, *gl);
        }
    }
}

TEST_F(Gl, RenderersLiveSideBySideAndLeaveNoContextBehind) {
    const Environment sky = test::make_lat_long(32, 16, test::two_lights);
    const Asset asset = make_scene({8, 8, 1, 20});
    const LightVector light = project_environment(sky, 8);
    const Camera camera = frame_asset(asset.view(), 40, 50, 40);
    auto first = GlRenderer::create(asset.view(), sky);
    ASSERT_TRUE(first.has_value());
    ASSERT_TRUE(first->set_light(light, {}));
    Picture alone = *first->render(camera);
    {
        auto second = GlRenderer::create(Asset{}.view(), sky);
        ASSERT_TRUE(second.has_value());
        ASSERT_TRUE(second->render(camera).has_value());
    }
    GlRenderer moved = std::move(*first);
    const auto after = moved.render(camera);
    ASSERT_TRUE(after.has_value());
    EXPECT_EQ(alone.pixel, after->pixel);
}

TEST_F(Gl, StatisticsAreFilledIn) {
    const Environment sky = test::make_lat_long(32, 16, test::two_lights);
    const Asset asset = make_scene({16, 8, 1, 100});
    auto renderer = GlRenderer::create(asset.view(), sky);
    ASSERT_TRUE(renderer.has_value());
    ASSERT_TRUE(renderer->set_light(project_environment(sky, 16), {}));
    ASSERT_TRUE(renderer->render(frame_asset(asset.view(), 40, 64, 48)).has_value());
    const GlStats& stats = renderer->stats();
    for (const double seconds : {stats.upload_seconds, stats.light_seconds, stats.dot_seconds,
                                 stats.draw_seconds, stats.readback_seconds}) {
        EXPECT_GT(seconds, 0.0);
    }
    EXPECT_GE(stats.gpu_bytes, asset.transport.code8.size() + asset.position.size() * 12);
    EXPECT_FALSE(stats.device.empty());
}

TEST_F(Gl, DamagedValuesNeverReachThePicture) {
    const Environment sky = test::make_lat_long(32, 16, test::two_lights);
    Asset asset = make_scene({16, 8, 3, 20});
    const Camera camera = frame_asset(asset.view(), 40, 60, 60);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    asset.position[200] = {nan, 0, 0};
    asset.position[201] = {inf, -inf, 0};
    asset.position[202] = {3e38f, -3e38f, 3e38f};
    asset.transport.detail_scale[3 * 250] = nan;
    asset.transport.average_scale[3 * 260] = inf;
    asset.transport.average_scale[3 * 270 + 1] = 3e38f;
    asset.base_color[280] = {inf, nan, -1};
    asset.texcoord.back() = {nan, inf};
    auto renderer = GlRenderer::create(asset.view(), sky);
    ASSERT_TRUE(renderer.has_value());
    ASSERT_TRUE(renderer->set_light(project_environment(sky, 16), {}));
    const auto picture = renderer->render(camera);
    ASSERT_TRUE(picture.has_value());
    for (const Rgb pixel : picture->pixel) {
        for (const float value : {pixel.r, pixel.g, pixel.b}) {
            EXPECT_TRUE(std::isfinite(value) && value >= 0);
        }
    }
}

TEST_F(Gl, WrongRequestsAreRefusedWithTheReason) {
    const Asset asset = make_scene({16, 8, 1, 20});
    const Environment sky = test::make_lat_long(32, 16, test::two_lights);
    auto renderer = GlRenderer::create(asset.view(), sky);
    ASSERT_TRUE(renderer.has_value());
    const auto wrong_size = renderer->set_light(project_environment(sky, 8), {});
    ASSERT_FALSE(wrong_size.has_value());
    EXPECT_EQ(wrong_size.error().kind, formats::ErrorKind::usage);
    Camera camera;
    camera.width = 0;
    EXPECT_FALSE(renderer->render(camera).has_value());
    EXPECT_FALSE(GlRenderer::create(asset.view(), sky, {.lanes_per_row = 3}).has_value());
    const auto too_small = GlRenderer::create(asset.view(), sky, {.max_block_bytes = 16});
    ASSERT_FALSE(too_small.has_value());
    EXPECT_EQ(too_small.error().kind, formats::ErrorKind::resource);
    Environment broken = sky;
    broken.pixel.pop_back();
    EXPECT_FALSE(GlRenderer::create(asset.view(), broken).has_value());
}

}  // namespace
}  // namespace opaline::runtime
