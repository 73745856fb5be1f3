#include "tests/runtime/gl/gl_comparison.h"

#include <cmath>
#include <iostream>

#include "runtime/gl/egl_context.h"
#include "runtime/shade.h"
#include "tests/runtime/gl/picture_difference.h"

namespace opaline::test {

using formats::Rgb;
using formats::TermSet;
using namespace runtime;

void Gl::SetUp() {
    const auto context = EglContext::create();
    if (!context) {
        std::cerr << "NO OPENGL ON THIS MACHINE: the GPU half is NOT tested: "
                  << context.error().diagnostics[0].fault << "\n";
        GTEST_SKIP() << context.error().diagnostics[0].fault;
    }
}

std::string text_of(const formats::Error& error) {
    return error.diagnostics[0].where + ": " + error.diagnostics[0].fault;
}

void expect_same_picture(const Picture& cpu, const Picture& gl) {
    ASSERT_EQ(cpu.width, gl.width);
    ASSERT_EQ(cpu.height, gl.height);
    const PictureDifference found = picture_difference(cpu.pixel, gl.pixel);
    ASSERT_TRUE(std::isfinite(found.mean));
    std::cout << "[ agreement] mean " << found.mean << ", off " << found.off << " of "
              << cpu.pixel.size() << "\n";
    EXPECT_TRUE(found.is_small());
}

void expect_displayable(const Picture& picture) {
    for (const Rgb pixel : picture.pixel) {
        for (const float value : {pixel.r, pixel.g, pixel.b}) {
            EXPECT_TRUE(std::isfinite(value) && value >= 0);
        }
    }
}

BothRenderers::BothRenderers(const formats::Asset& asset, const formats::Environment& sky,
                             const Rotation& rotation, const GlOptions& options)
    : asset_(asset), sky_(sky), rotation_(rotation), renderer([&] {
          auto made = GlRenderer::create(asset.view(), sky, options);
          EXPECT_TRUE(made.has_value()) << text_of(made.error());
          return std::move(made).value();
      }()) {
    const formats::AssetView view = asset.view();
    if (view.cubemap_size > 0) light_ = project_environment(sky, view.cubemap_size, rotation);
    const bool is_other = options.mirrored != nullptr;
    specular_ = make_specular_light(is_other ? *options.mirrored : sky, specular_needs(view),
                                    is_other ? Rotation{} : rotation, 0);
    EXPECT_TRUE(renderer.set_light(light_, rotation));
}

void BothRenderers::set_emitters(const EmitterLight& emitters) {
    emitters_ = emitters;
    EXPECT_TRUE(renderer.set_light(light_, rotation_, emitters));
}

void BothRenderers::set_layers(const LayerLightOptions& options) {
    layers_ = light_layers(asset_.view().clouds, sky_, rotation_, options);
    const auto shown = renderer.set_layers(*layers_);
    EXPECT_TRUE(shown.has_value()) << text_of(shown.error());
}

Picture BothRenderers::on_cpu(const Camera& camera, const GlRenderOptions& options) const {
    const formats::AssetView view = asset_.view();
    SoftwareOptions software;
    software.supersampling = options.supersampling;
    software.background = options.background;
    software.emitters = emitters_;
    software.lights = light_;
    if (has_any(options.terms, TermSet::specular)) software.specular = &specular_;
    if (layers_) software.layers = &*layers_;
    VolumeLight volumes;
    if (!view.volumes.empty()) {
        volumes =
            relight_volumes(view.volumes, light_, {.terms = options.terms, .emitters = emitters_});
        software.volumes = &volumes;
    }
    auto picture = render_software(
        view, shade_for_picture(view, light_, camera.eye, options.terms, 0, emitters_), sky_,
        rotation_, camera, software);
    EXPECT_TRUE(picture.has_value()) << text_of(picture.error());
    return std::move(picture).value();
}

Picture BothRenderers::on_gl(const Camera& camera, const GlRenderOptions& options) {
    auto picture = renderer.render(camera, options);
    EXPECT_TRUE(picture.has_value()) << text_of(picture.error());
    return std::move(picture).value();
}

void BothRenderers::expect_agreement(const Camera& camera, const GlRenderOptions& options) {
    const Picture gl = on_gl(camera, options);
    expect_same_picture(on_cpu(camera, options), gl);
    if (options.terms != TermSet::all) return;
    const auto cpu_radiance =
        shade_for_picture(asset_.view(), light_, camera.eye, TermSet::all, 0, emitters_);
    const auto gl_radiance = renderer.read_radiance();
    ASSERT_TRUE(gl_radiance && gl_radiance->size() == cpu_radiance.size());
    for (std::size_t v = 0; v < cpu_radiance.size(); ++v) {
        const Rgb a = cpu_radiance[v], b = (*gl_radiance)[v];
        for (const auto& [x, y] : {std::pair{a.r, b.r}, {a.g, b.g}, {a.b, b.b}}) {
            EXPECT_NEAR(x, y, 2e-5f * (std::abs(x) + 1)) << "vertex " << v;
        }
    }
}

}  // namespace opaline::test
