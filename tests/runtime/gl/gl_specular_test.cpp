#include <gtest/gtest.h>

#include <cmath>

#include "runtime/gl/gl_renderer.h"
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
using formats::TermSet;
using test::expect_same_picture;
using test::text_of;

class GlSpecular : public test::Gl {};
class GlTerms : public test::Gl {};

// Two translucent spheres of different gloss and a matt one over a diffuse floor, and a textured,
// glossy, double-sided board seen from behind. Multiple scattering in rows of its own.
Asset make_scene(std::uint32_t terms, std::uint32_t details = 64) {
    Asset asset = test::make_asset(16, 8);
    asset.images.push_back(test::make_noise_image(13, 9));
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1), {});
    const test::TestPrimitive body{
        .bands = 3, .details = details, .eta = 1.4f, .terms = terms, .is_separate = true};
    for (const float x : {-2.1f, 0.0f, 2.1f}) {
        test::add_primitive(asset, test::make_sphere({x, 1, 0}, 1, 24, 16), body);
    }
    test::TestPrimitive board = body;
    board.image = 0;
    board.is_double_sided = true;
    test::add_primitive(
        asset, test::make_sheet({1, 2.6f, 0}, {-0.8f, 0, 0.1f}, {0, 0.5f, 0}, 4, 1.8f), board);
    asset.roughness = {formats::kNotGlossy, 0.1f, 0.45f, formats::kNotGlossy, 0.45f};
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const float t = static_cast<float>(v);
        const formats::Vec3 tilt{std::sin(t), std::sin(2 * t), std::cos(3 * t)};
        asset.openness.push_back(formats::encode_openness(asset.normal[v] + 0.3f * tilt,
                                                          0.7f + 0.4f * std::sin(0.3f * t)));
    }
    return asset;
}

struct Lit {
    explicit Lit(const AssetView& asset)
        : light(project_environment(sky, 16, rotation)),
          specular(prefilter_specular(sky, roughness_levels(asset), rotation, 0)) {}
    Environment sky = test::make_lat_long(128, 64, test::two_lights);
    Rotation rotation = rotation_about_y(0.7f);
    LightVector light;
    SpecularLight specular;
};

formats::Result<Picture> draw_on_cpu(const AssetView& asset, const Lit& lit, const Camera& camera,
                                     TermSet terms, bool background) {
    std::vector<Rgb> radiance(asset.receivers());
    shade(asset, lit.light, radiance,
          {.base_color = false, .eye = camera.eye, .fresnel = false, .terms = terms});
    SoftwareOptions options;
    options.specular = has_any(terms, TermSet::specular) ? &lit.specular : nullptr;
    options.background = background;
    return render_software(asset, radiance, lit.sky, lit.rotation, camera, options);
}

TEST_F(GlSpecular, PicturesAgreeWithTheCpu) {
    const Asset asset = make_scene(5), bare = [] {
        Asset a = make_scene(5);
        a.roughness.clear(), a.openness.clear();
        return a;
    }();
    const AssetView view = asset.view();
    const Lit lit(view);
    auto renderer = GlRenderer::create(view, lit.sky);
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light(lit.light, lit.rotation));
    Camera camera = frame_asset(view, 45, 200, 150);
    camera.fov_y = 18;  // the bodies, not the floor around them
    for (const float degrees : {0.0f, 170.0f}) {
        const Camera at = orbit(camera, degrees);
        const auto cpu = draw_on_cpu(view, lit, at, TermSet::all, true);
        const auto gl = renderer->render(at);
        ASSERT_TRUE(cpu.has_value());
        ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
        expect_same_picture(*cpu, *gl);
        // The comparison means nothing unless gloss changes the picture.
        const auto matt = draw_on_cpu(bare.view(), lit, at, TermSet::all, true);
        ASSERT_TRUE(matt.has_value());
        double gloss = 0, sum = 0;
        for (std::size_t i = 0; i < cpu->pixel.size(); ++i) {
            gloss += cpu->pixel[i].g - matt->pixel[i].g;
            sum += matt->pixel[i].g;
        }
        EXPECT_GT(gloss, 0.002 * sum);
    }
}

// What a cloud layer makes of a light stands in the world's frame; the background is the light's.
TEST_F(GlSpecular, AnotherEnvironmentThanTheBackgroundIsMirrored) {
    const Asset asset = make_scene(2);
    const AssetView view = asset.view();
    Lit lit(view);
    const Environment mirrored = test::make_lat_long(32, 16, [](formats::Vec3 d) {
        return Rgb{1 + d.y, 1 + d.x, 2 - d.z * d.x};
    });
    lit.specular = prefilter_specular(mirrored, roughness_levels(view), {}, 0);
    auto renderer = GlRenderer::create(view, lit.sky, {.mirrored = &mirrored});
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light(lit.light, lit.rotation));
    Camera camera = frame_asset(view, 45, 80, 60);
    camera.fov_y = 18;
    const auto cpu = draw_on_cpu(view, lit, camera, TermSet::all, true);
    const auto gl = renderer->render(camera);
    ASSERT_TRUE(cpu.has_value());
    ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
    expect_same_picture(*cpu, *gl);
}

TEST_F(GlTerms, EachComponentAgreesWithTheCpuAndTheyAddUp) {
    for (const std::uint32_t terms : {1u, 2u, 5u, 26u}) {
        SCOPED_TRACE(testing::Message() << terms << " rows a vertex");
        const Asset asset = make_scene(terms);
        const AssetView view = asset.view();
        const Lit lit(view);
        auto renderer = GlRenderer::create(view, lit.sky);
        ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
        ASSERT_TRUE(renderer->set_light(lit.light, lit.rotation));
        const Camera camera = frame_asset(view, 45, 160, 120);
        for (const TermSet shown : {TermSet::all, TermSet::multiple, TermSet::single,
                                    TermSet::specular, TermSet::diffuse}) {
            SCOPED_TRACE(testing::Message() << "components " << formats::term_names(shown));
            GlRenderOptions options;
            options.terms = shown;
            options.background = false;
            const auto cpu = draw_on_cpu(view, lit, camera, shown, false);
            const auto gl = renderer->render(camera, options);
            ASSERT_TRUE(cpu.has_value());
            ASSERT_TRUE(gl.has_value()) << text_of(gl.error());
            if (terms == 1 && shown == TermSet::single) {
                for (const Rgb c : gl->pixel)
                    EXPECT_EQ(c, Rgb{});  // it has no such rows
            } else {
                expect_same_picture(*cpu, *gl);
            }
        }
    }
}

// The rows of these are negative by rounding alone, so that next to nothing is clamped and
// everything is linear.
TEST_F(GlTerms, ComponentsAddUpToTheWholePicture) {
    const Asset asset = make_scene(2, 2000);
    const AssetView view = asset.view();
    const Lit lit(view);
    auto renderer = GlRenderer::create(view, lit.sky);
    ASSERT_TRUE(renderer.has_value()) << text_of(renderer.error());
    ASSERT_TRUE(renderer->set_light(lit.light, lit.rotation));
    const Camera camera = frame_asset(view, 45, 120, 90);
    for (const bool on_gpu : {false, true}) {
        const auto draw = [&](TermSet terms) {
            GlRenderOptions options;
            options.terms = terms;
            options.background = false;
            auto picture = on_gpu ? renderer->render(camera, options)
                                  : draw_on_cpu(view, lit, camera, terms, false);
            EXPECT_TRUE(picture.has_value());
            return picture ? std::move(picture).value().pixel : std::vector<Rgb>();
        };
        std::vector<Rgb> whole = draw(TermSet::all), sum(whole.size());
        for (const TermSet term :
             {TermSet::multiple, TermSet::single, TermSet::specular, TermSet::diffuse}) {
            const std::vector<Rgb> part = draw(term);
            ASSERT_EQ(part.size(), whole.size());
            double total = 0;
            for (std::size_t i = 0; i < whole.size(); ++i) {
                sum[i] = sum[i] + part[i];
                total += part[i].g;
            }
            EXPECT_GT(total, 0) << formats::term_names(term);
        }
        for (std::size_t i = 0; i < whole.size(); ++i) {
            ASSERT_NEAR(sum[i].r, whole[i].r, 2e-3f + 1e-5f * whole[i].r) << on_gpu << " " << i;
            ASSERT_NEAR(sum[i].b, whole[i].b, 2e-3f + 1e-5f * whole[i].b) << on_gpu << " " << i;
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
