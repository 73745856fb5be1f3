#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/gl/gl_renderer.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "runtime/view_terms.h"
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
using test::text_of;

class GlTranslucent : public test::Gl {};

// A translucent sphere of so many bands over a diffuse floor, and two textured boards seen from
// behind, of which one is double-sided.
Asset make_scene(std::uint32_t terms, float eta, std::uint32_t bands = 3) {
    Asset asset = test::make_asset(16, 8);
    asset.images.push_back(test::make_noise_image(13, 9));
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1), {});
    test::add_primitive(asset, test::make_sphere({0, 1, 0}, 1, 32, 20),
                        {.bands = bands, .eta = eta, .terms = terms});
    for (const bool is_double_sided : {false, true}) {
        test::add_primitive(asset,
                            test::make_sheet({is_double_sided ? -1.5f : 1.5f, 1.0f, -0.5f},
                                             {-0.4f, 0, 0.1f}, {0, 0.5f, 0}, 4, 1.8f),
                            {.bands = 3,
                             .image = 0,
                             .eta = eta,
                             .terms = terms,
                             .is_double_sided = is_double_sided});
    }
    return asset;
}

std::vector<Rgb> view_on_cpu(const AssetView& asset, const LightVector& light,
                             const Camera& camera) {
    std::vector<Rgb> radiance(asset.receivers());
    shade(asset, light, radiance, {.base_color = false, .eye = camera.eye, .fresnel = false});
    return radiance;
}

// Among them grey media next to coloured ones.
TEST_F(GlTranslucent, PicturesAgreeWithTheCpuForEveryNumberOfTermsAndBands) {
    const Environment sky = test::make_lat_long(128, 64, test::two_lights);
    const Rotation rotation = rotation_about_y(0.7f);
    struct TermsAndBands {
        std::uint32_t terms;
        float eta;
        std::uint32_t bands;
    };
    for (const auto& [terms, eta, bands] :
         {TermsAndBands{1, 1.3f, 3}, TermsAndBands{4, 1.3f, 3}, TermsAndBands{4, 0.7f, 3},
          TermsAndBands{9, 1.0f, 3}, TermsAndBands{16, 1.5f, 3}, TermsAndBands{25, 3.0f, 3},
          TermsAndBands{1, 1.3f, 1}, TermsAndBands{4, 1.3f, 1}}) {
        SCOPED_TRACE(testing::Message()
                     << terms << " terms, eta " << eta << ", " << bands << " bands");
        const Asset asset = make_scene(terms, eta, bands);
        const AssetView view = asset.view();
        const LightVector light = project_environment(sky, 16, rotation);
        auto renderer = GlRenderer::create(view, sky);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        ASSERT_TRUE(renderer->set_light(light, rotation));
        // Twice around: the second view must not see the first one's sums.
        Camera camera = frame_asset(view, 45, 200, 150);
        for (const float degrees : {0.0f, 160.0f}) {
            const Camera at = orbit(camera, degrees);
            const std::vector<Rgb> radiance = view_on_cpu(view, light, at);
            const auto cpu = render_software(view, radiance, sky, rotation, at);
            const auto gl = renderer->render(at);
            ASSERT_TRUE(cpu.has_value());
            ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
            const auto on_gl = renderer->read_radiance();
            ASSERT_TRUE(on_gl.has_value());
            expect_same_radiance(radiance, *on_gl);
            expect_same_picture(*cpu, *gl);
        }
    }
}

// Seen from in front and from behind, beside a medium of as many rows.
TEST_F(GlTranslucent, PicturesOfThinWalledSurfacesAgreeWithTheCpu) {
    const Environment sky = test::make_lat_long(128, 64, test::two_lights);
    for (const std::uint32_t bands : {1u, 3u}) {
        Asset asset = test::make_asset(16, 8);
        asset.images.push_back(test::make_noise_image(13, 9));
        for (const float turn : {1.0f, -1.0f}) {
            test::add_primitive(
                asset,
                test::make_sheet({turn, 1, 0}, {0.7f * turn, 0, 0.2f}, {0, 0.8f, 0.1f}, 4, 1.8f),
                {.bands = bands, .image = turn > 0 ? 0 : formats::kNoImage, .is_sheet = true});
        }
        test::add_primitive(asset, test::make_sphere({0, 1, 1.5f}, 0.4f, 16, 10),
                            {.bands = 3, .eta = 1.3f, .terms = 2, .is_separate = true});
        const AssetView view = asset.view();
        const LightVector light = project_environment(sky, 16);
        auto renderer = GlRenderer::create(view, sky);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        ASSERT_TRUE(renderer->set_light(light, {}));
        const Camera camera = frame_asset(view, 45, 200, 150);
        for (const float degrees : {0.0f, 180.0f}) {
            const Camera at = orbit(camera, degrees);
            const std::vector<Rgb> radiance = view_on_cpu(view, light, at);
            const auto cpu = render_software(view, radiance, sky, {}, at);
            const auto gl = renderer->render(at);
            ASSERT_TRUE(cpu.has_value());
            ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
            const auto on_gl = renderer->read_radiance();
            ASSERT_TRUE(on_gl.has_value());
            expect_same_radiance(radiance, *on_gl);
            expect_same_picture(*cpu, *gl);
        }
    }
}

TEST_F(GlTranslucent, SeveralDispatchesMakeTheSamePicture) {
    const Environment sky = test::make_lat_long(64, 32, test::two_lights);
    const Asset asset = make_scene(4, 1.3f);
    const AssetView view = asset.view();
    const LightVector light = project_environment(sky, 16);
    const Camera camera = frame_asset(view, 45, 101, 67);
    const std::vector<Rgb> radiance = view_on_cpu(view, light, camera);
    const auto cpu = render_software(view, radiance, sky, {}, camera);
    ASSERT_TRUE(cpu.has_value());
    for (const GlOptions& options : {GlOptions{1, 0}, GlOptions{32, 0}, GlOptions{4, 8192}}) {
        auto renderer = GlRenderer::create(view, sky, options);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        EXPECT_EQ(renderer->stats().dispatches > view.primitives.size(),
                  options.max_block_bytes != 0);
        ASSERT_TRUE(renderer->set_light(light, {}));
        const auto gl = renderer->render(camera);
        ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
        expect_same_radiance(radiance, *renderer->read_radiance());
        expect_same_picture(*cpu, *gl);
    }
}

TEST_F(GlTranslucent, ExtremeScalesAndViewsFromInsideAgree) {
    const Environment sky = test::make_lat_long(64, 32, test::two_lights);
    for (const float scale : {1e-12f, 1e12f}) {
        Asset asset = make_scene(4, 1.3f);
        for (formats::Vec3& p : asset.position) {
            p = scale * p;
        }
        const AssetView view = asset.view();
        const LightVector light = project_environment(sky, 16);
        auto renderer = GlRenderer::create(view, sky);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        ASSERT_TRUE(renderer->set_light(light, {}));
        Camera camera = frame_asset(view, 40, 120, 90);
        for (const bool inside : {false, true}) {
            if (inside) {
                camera.eye = scale * formats::Vec3{0.1f, 1.1f, 0.3f};
                camera.target = scale * formats::Vec3{0, 1, 0};
                camera.near_plane = scale * 1.2f;  // beyond the sphere: the floor and the boards
            }
            const auto cpu =
                render_software(view, view_on_cpu(view, light, camera), sky, {}, camera);
            const auto gl = renderer->render(camera);
            ASSERT_TRUE(cpu && gl);
            expect_same_picture(*cpu, *gl);
        }
    }
}

TEST_F(GlTranslucent, DamagedValuesNeverReachThePicture) {
    const Environment sky = test::make_lat_long(32, 16, test::two_lights);
    Asset asset = make_scene(4, 1.3f);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    asset.normal[200] = {nan, 0, 0};
    asset.normal[201] = {};
    asset.normal[202] = {inf, -inf, 0};
    asset.position[210] = {3e38f, -3e38f, 3e38f};
    // Behind the floor's 16 grey rows: three bands a row, four rows a vertex.
    const std::size_t sphere = asset.primitives[1].first_band_row;
    asset.transport.detail_scale[sphere + 12 * 250] = nan;
    asset.transport.average_scale[sphere + 12 * 260 + 3] = inf;
    asset.transport.average_scale[sphere + 12 * 270 + 7] = 3e38f;
    asset.base_color[280] = {inf, nan, -1};
    auto renderer = GlRenderer::create(asset.view(), sky);
    ASSERT_TRUE(renderer.has_value());
    const LightVector light = project_environment(sky, 16);
    ASSERT_TRUE(renderer->set_light(light, {}));
    const Camera camera = frame_asset(make_scene(4, 1.3f).view(), 40, 60, 60);
    const auto gl = renderer->render(camera);
    const auto cpu =
        render_software(asset.view(), view_on_cpu(asset.view(), light, camera), sky, {}, camera);
    ASSERT_TRUE(gl && cpu);
    for (const auto& picture : {*gl, *cpu}) {
        for (const Rgb pixel : picture.pixel) {
            for (const float value : {pixel.r, pixel.g, pixel.b}) {
                EXPECT_TRUE(std::isfinite(value) && value >= 0);
            }
        }
    }
}

TEST_F(GlTranslucent, SpheresDarkenTowardTheirEdgeAsFresnelSays) {
    // White light and one term: radiance is base colour times Ft under a normal that turns away.
    const Environment white = test::make_lat_long(64, 32, [](formats::Vec3) {
        return Rgb{1, 1, 1};
    });
    Asset asset = test::make_asset(16, 16);
    test::add_primitive(asset, test::make_sphere({0, 0, 0}, 1, 64, 40),
                        {.bands = 3, .details = 2000, .eta = 1.5f});
    std::ranges::fill(asset.base_color, Rgb{1, 1, 1});
    auto renderer = GlRenderer::create(asset.view(), white);
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light(project_environment(white, 16), {}));
    Camera camera;
    camera.eye = {0, 0, 1000};
    camera.near_plane = 900;
    camera.fov_y = 0.14f;
    camera.width = camera.height = 101;
    const auto picture = renderer->render(camera, {1, 2048});
    ASSERT_TRUE(picture.has_value());
    const double half = 1000 * std::tan(0.07 * std::numbers::pi / 180);
    for (std::uint32_t x = 50; x < 101; ++x) {
        const double r = (x - 50) / 50.5 * half;
        if (r > 0.95) continue;  // facets of the silhouette
        const float cosine = static_cast<float>(std::sqrt(1 - r * r));
        EXPECT_NEAR(picture->pixel[std::size_t{50} * 101 + x].r,
                    fresnel_transmittance(cosine, 1.5f), 6e-3)  // facets, 2000 details
            << "at radius " << r;
    }
}

}  // namespace
}  // namespace opaline::runtime
