// Light of emitters: the same picture as on the CPU.
#include "runtime/gl/gl_emitters.h"

#include <gtest/gtest.h>

#include "runtime/gl/gl_renderer.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;
using test::Gl;

// A floor, a thin-walled board and a translucent sphere, each lit; the floor and the board glow.
Asset glowing_asset() {
    Asset asset = test::make_asset(8, 8);
    asset.images.push_back(test::make_noise_image(7, 5));
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, 4, 2), {});
    test::add_primitive(asset, test::make_sheet({-1.5f, 1, 0}, {0.5f, 0, 0}, {0, 0.7f, 0}, 2, 1),
                        {.bands = 3, .is_sheet = true});
    test::add_primitive(asset, test::make_sphere({1, 1, 0}, 0.8f, 16, 10),
                        {.bands = 3, .eta = 1.3f, .terms = 4});
    append_emitter(asset.emitters, "a");
    append_emitter(asset.emitters, "b");
    for (std::uint32_t p = 0; p < 3; ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        std::vector<Rgb> rows;
        for (std::uint32_t i = 0; i < primitive.vertex_count * primitive.terms; ++i) {
            rows.push_back(
                {0.3f * static_cast<float>(i % 5), 0.2f * static_cast<float>(i % 3), 0.5f});
        }
        append_block(asset.emitters, p % 2, p, rows);
    }
    asset.emitters.own = {
        {0, 0, {0.5f, 0.2f, 0.1f}, 0, formats::Wrap::repeat, formats::Wrap::mirror},
        {1, 1, {0.1f, 0.1f, 0.9f}}};
    return asset;
}

TEST_F(Gl, EmittersAgreeWithTheCpuLitAndSwitchedOff) {
    const Asset asset = glowing_asset();
    const formats::Environment sky = test::make_lat_long(64, 32, test::two_lights);
    const LightVector light = project_environment(sky, 8);
    auto renderer = GlRenderer::create(asset.view(), sky);
    ASSERT_TRUE(renderer) << test::text_of(renderer.error());
    Camera camera;
    camera.eye = {0.5f, 2, 5};
    camera.target = {0, 0.8f, 0};
    camera.width = 160;
    camera.height = 120;
    const std::vector<Rgb> dimmed{{2, 1, 0.5f}, {0, 0, 0}};
    for (const EmitterLight& emitters : {EmitterLight{}, EmitterLight{dimmed, true},
                                         EmitterLight{dimmed, false}, dark_emitters()}) {
        ASSERT_TRUE(renderer->set_light(light, {}, emitters));
        const auto gl = renderer->render(camera);
        ASSERT_TRUE(gl);
        SoftwareOptions options;
        options.emitters = emitters;
        const auto cpu = render_software(
            asset.view(),
            shade_for_picture(asset.view(), light, camera.eye, formats::TermSet::all, 0, emitters),
            sky, {}, camera, options);
        ASSERT_TRUE(cpu);
        test::expect_same_picture(*cpu, *gl);
    }
}

}  // namespace
}  // namespace opaline::runtime
