#include <gtest/gtest.h>

#include <cmath>

#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::GlossRecord;
using formats::TermSet;

class GlGloss : public test::Gl {};

// Metals of three roughnesses, one for each way the lobe is summed up, a dielectric floor, and a
// textured, double-sided board whose roughness and metallic vary; a translucent glossy ball beside
// them.
Asset make_scene() {
    Asset asset = test::make_asset(16, 8);
    asset.images.push_back(test::make_noise_image(13, 9));
    asset.images.push_back(test::make_noise_image(7, 5));
    const test::TestPrimitive opaque{.bands = 3};
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1), {});
    for (const float x : {-2.1f, 0.0f, 2.1f}) {
        test::add_primitive(asset, test::make_sphere({x, 1, 0}, 1, 24, 16), opaque);
    }
    test::TestPrimitive board = opaque;
    board.image = 0;
    board.is_double_sided = true;
    test::add_primitive(
        asset, test::make_sheet({1, 2.6f, 0}, {-0.8f, 0, 0.1f}, {0, 0.5f, 0}, 4, 1.8f), board);
    test::add_primitive(asset, test::make_sphere({-1.5f, 2.6f, 0}, 0.5f, 16, 12),
                        {.bands = 3, .eta = 1.4f});
    asset.roughness.assign(6, formats::kNotGlossy);
    asset.roughness[5] = 0.3f;
    asset.gloss.assign(6, GlossRecord{});
    for (std::size_t p = 0; p < 5; ++p) {
        asset.gloss[p].f0 = {0.04f, 0.05f, 0.06f};
        asset.gloss[p].f90 = 0.9f;
        asset.gloss[p].metallic = p == 0 ? 0.0f : 1.0f;
    }
    asset.gloss[0].roughness = 0.35f;
    asset.gloss[1].roughness = 0.15f;
    asset.gloss[2].roughness = 0.45f;
    asset.gloss[3].roughness = 0.9f;
    asset.gloss[4].roughness = 0.8f;
    asset.gloss[4].image = 1;
    asset.gloss[4].wrap_u = formats::Wrap::mirror;
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const float t = static_cast<float>(v);
        const formats::Vec3 tilt{std::sin(t), std::sin(2 * t), std::cos(3 * t)};
        asset.openness.push_back(formats::encode_openness(asset.normal[v] + 0.3f * tilt,
                                                          0.8f + 0.4f * std::sin(0.3f * t)));
    }
    return asset;
}

TEST_F(GlGloss, PicturesAgreeWithTheCpuInEveryComponent) {
    const Asset asset = make_scene();
    formats::Environment sky = tests::lat_long_map(128, 64, test::two_lights);
    sky.discs = {{normalize(formats::Vec3{0.3f, 0.8f, 0.5f}), 0.0046f, {8000, 7000, 6000}}};
    test::BothRenderers both(asset, sky, rotation_about_y(0.7f));
    Camera camera = frame_asset(asset.view(), 45, 120, 90);
    camera.fov_y = 20;  // the bodies, not the floor around them
    for (const float degrees : {0.0f, 170.0f}) {
        for (const TermSet terms : {TermSet::all, TermSet::specular, TermSet::diffuse}) {
            SCOPED_TRACE(testing::Message() << formats::term_names(terms) << ' ' << degrees);
            both.expect_agreement(orbit(camera, degrees),
                                  {.terms = terms, .background = terms == TermSet::all});
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
