#include "runtime/gl/gl_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/shade.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/every_surface.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Environment;
using formats::Rgb;
using test::BothRenderers;
using test::Gl;

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

TEST_F(Gl, DotProductsAndPicturesAgreeWithTheCpuForEveryKindOfRow) {
    const Environment sky = tests::lat_long_map(128, 64, test::two_lights);
    for (const Variant& variant :
         {Variant{16, 8, 1, 100}, Variant{16, 8, 3, 60}, Variant{16, 16, 1, 200},
          Variant{8, 16, 3, 33}, Variant{128, 8, 3, 150}, Variant{128, 16, 1, 150}}) {
        SCOPED_TRACE(testing::Message() << "n " << variant.n << ", " << variant.code_bits
                                        << " bits, " << variant.bands << " bands");
        const Asset asset = make_scene(variant);
        BothRenderers(asset, sky, rotation_about_y(0.7f))
            .expect_agreement(frame_asset(asset.view(), 45, 120, 90));
    }
}

TEST_F(Gl, EverySurfaceAgreesWithItsEmittersLitDimmedAndSwitchedOff) {
    const Asset asset = test::make_every_surface();
    BothRenderers both(asset, tests::lat_long_map(64, 32, test::two_lights));
    const std::vector<Rgb> dimmed{{2, 1, 0.5f}, {0, 0, 0}};
    for (const EmitterLight& emitters : {EmitterLight{}, EmitterLight{dimmed, true},
                                         EmitterLight{dimmed, false}, dark_emitters()}) {
        both.set_emitters(emitters);
        both.expect_agreement(
            {.eye = {0.5f, 2, 7}, .target = {0, 0.7f, 0}, .fov_y = 32, .width = 80, .height = 60});
    }
}

TEST_F(Gl, ResultDoesNotDependOnLanesBlocksOrTiles) {
    const Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    const Asset asset = make_scene({16, 8, 3, 77});
    const Camera camera = frame_asset(asset.view(), 45, 101, 67);
    Picture first;
    for (const GlOptions& options : {GlOptions{1, 0}, GlOptions{4, 0}, GlOptions{16, 0},
                                     GlOptions{32, 0}, GlOptions{1, 4096}, GlOptions{16, 8192}}) {
        SCOPED_TRACE(testing::Message()
                     << options.lanes_per_row << " lanes, " << options.max_block_bytes << " bytes");
        BothRenderers both(asset, sky, {}, options);
        EXPECT_EQ(both.renderer.stats().lanes_per_row, options.lanes_per_row);
        EXPECT_EQ(both.renderer.stats().dispatches > asset.primitives.size(),
                  options.max_block_bytes != 0);
        both.expect_agreement(camera);
        for (const std::uint32_t tile : {2048u, 96u, 1u}) {
            if (tile == 1 && !first.pixel.empty()) continue;  // a pixel at a time: once is enough
            const Picture picture = both.on_gl(camera, {3, tile});
            if (first.pixel.empty()) first = picture;
            test::expect_same_picture(first, picture);
        }
    }
}

TEST_F(Gl, PrimitivesHaveLightsOfTheirOwn) {
    const Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    const Asset asset = make_scene({16, 8, 3, 77});
    const std::vector<LightVector> light{project_environment(sky, 16),
                                         project_environment(sky, 16, rotation_about_y(2))};
    const std::vector<std::uint32_t> of_primitive{1, 0, 1, 1, 0};
    const PartLights lights{light, of_primitive, 0};
    const auto shaded = [&](const PartLights& by) {
        return shade_for_picture(asset.view(), by, {}, formats::TermSet::all, 0);
    };
    const std::vector<Rgb> radiance = shaded(lights);
    EXPECT_NE(radiance, shaded(light[0]));
    BothRenderers both(asset, sky);
    ASSERT_TRUE(both.renderer.set_light(lights, {}));
    const auto on_gl = both.renderer.read_radiance();
    ASSERT_TRUE(on_gl && on_gl->size() == radiance.size());
    for (std::size_t v = 0; v < radiance.size(); ++v) {
        EXPECT_NEAR(radiance[v].g, (*on_gl)[v].g, 2e-5f * (std::abs(radiance[v].g) + 1)) << v;
    }
    EXPECT_FALSE(both.renderer.set_light({light, std::span(of_primitive).first(4), 0}, {}));
    EXPECT_FALSE(both.renderer.set_light({std::span(light).first(1), of_primitive, 0}, {}));
    EXPECT_FALSE(both.renderer.set_light({light, of_primitive, 2}, {}));
}

TEST_F(Gl, BackgroundAgreesForEveryLayoutAndRotation) {
    Environment poles = tests::lat_long_map(64, 33, test::two_lights);
    poles.rows_include_poles = true;
    poles.u_offset = 0.1f;
    poles.u_sign = -1;
    poles.discs.push_back({normalize(formats::Vec3{0.3f, 0.4f, -0.8f}), 0.05f, {20, 10, 5}});
    Environment discs_alone;
    discs_alone.discs = {{{0, 0, -1}, 0.2f, {1, 2, 3}},
                         {normalize(formats::Vec3{0.1f, 0, -1}), 0.2f, {3, 2, 1}}};
    const Rotation tilted{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    const Asset nothing;
    for (const Environment& sky : {poles, discs_alone, tests::cube_map(16, test::two_lights)}) {
        for (const Rotation& rotation : {Rotation{}, rotation_about_y(2.0f), tilted}) {
            BothRenderers both(nothing, sky, rotation);
            for (const formats::Vec3 target :
                 {formats::Vec3{0, 0, -1}, formats::Vec3{-1, 1, 1}, formats::Vec3{0, -1, 0.1f}}) {
                const Camera camera{
                    .eye = {0, 0, 0}, .target = target, .fov_y = 100, .width = 160, .height = 120};
                if (std::ranges::any_of(both.on_cpu(camera).pixel,
                                        [](Rgb c) { return luminance(c) > 0; })) {
                    both.expect_agreement(camera);
                }
            }
        }
    }
}

TEST_F(Gl, CameraInsideTheMeshAgrees) {
    const Asset asset = make_scene({16, 8, 1, 50});
    BothRenderers both(asset, tests::lat_long_map(64, 32, test::two_lights));
    for (const float near_plane : {1e-3f, 1.0f}) {  // in front of the wall and cutting through it
        both.expect_agreement({.eye = {0.2f, 0.9f, 0.3f},
                               .target = {-3, 0.2f, -2},
                               .fov_y = 90,
                               .width = 150,
                               .height = 110,
                               .near_plane = near_plane});
    }
}

TEST_F(Gl, OnePixelAndExtremeScalesAgree) {
    for (const float scale : {1e-12f, 1.0f, 1e12f}) {
        Asset asset = make_scene({8, 8, 1, 20});
        for (formats::Vec3& p : asset.position) {
            p = scale * p;
        }
        BothRenderers both(asset, tests::lat_long_map(64, 32, test::two_lights));
        for (const std::uint32_t size : {1u, 120u}) {
            both.expect_agreement(frame_asset(asset.view(), 40, size, size));
        }
    }
}

TEST_F(Gl, RenderersLiveSideBySideAndLeaveNoContextBehind) {
    const Environment sky = tests::lat_long_map(32, 16, test::two_lights);
    const Asset asset = make_scene({8, 8, 1, 20}), nothing;
    const Camera camera = frame_asset(asset.view(), 40, 50, 40);
    BothRenderers first(asset, sky);
    const Picture alone = first.on_gl(camera);
    BothRenderers(nothing, sky).on_gl(camera);
    GlRenderer moved = std::move(first.renderer);
    const auto after = moved.render(camera);
    ASSERT_TRUE(after.has_value());
    EXPECT_EQ(alone.pixel, after->pixel);
}

TEST_F(Gl, DamagedValuesNeverReachThePicture) {
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
    BothRenderers both(asset, tests::lat_long_map(32, 16, test::two_lights));
    test::expect_displayable(both.on_gl(camera));
}

TEST_F(Gl, WrongRequestsAreRefusedWithTheReason) {
    const Asset asset = make_scene({16, 8, 1, 20});
    const Environment sky = tests::lat_long_map(32, 16, test::two_lights);
    BothRenderers both(asset, sky);
    const auto wrong_size = both.renderer.set_light(project_environment(sky, 8), {});
    ASSERT_FALSE(wrong_size.has_value());
    EXPECT_EQ(wrong_size.error().kind, formats::ErrorKind::usage);
    EXPECT_FALSE(both.renderer.render({.width = 0}).has_value());
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
