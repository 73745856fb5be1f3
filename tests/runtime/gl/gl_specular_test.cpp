#include <gtest/gtest.h>

#include <cmath>

#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Environment;
using formats::Rgb;
using formats::TermSet;
using test::BothRenderers;

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

const Environment& sky() {
    static const Environment made = tests::lat_long_map(128, 64, test::two_lights);
    return made;
}
const Rotation kTurned = rotation_about_y(0.7f);

// The bodies, not the floor around them.
Camera camera_at_bodies(const Asset& asset, std::uint32_t width, std::uint32_t height) {
    Camera camera = frame_asset(asset.view(), 45, width, height);
    camera.fov_y = 18;
    return camera;
}

// What a cloud layer makes of a light stands in the world's frame; the background is the light's.
TEST_F(GlSpecular, AnotherEnvironmentThanTheBackgroundIsMirrored) {
    const Asset asset = make_scene(2);
    const Environment mirrored = tests::lat_long_map(32, 16, [](formats::Vec3 d) {
        return Rgb{1 + d.y, 1 + d.x, 2 - d.z * d.x};
    });
    BothRenderers both(asset, sky(), kTurned, {.mirrored = &mirrored});
    both.expect_agreement(camera_at_bodies(asset, 80, 60));
}

TEST_F(GlTerms, EachComponentAgreesWithTheCpuAndTheyAddUp) {
    for (const std::uint32_t terms : {1u, 2u, 5u, 26u}) {
        SCOPED_TRACE(testing::Message() << terms << " rows a vertex");
        const Asset asset = make_scene(terms);
        BothRenderers both(asset, sky(), kTurned);
        const Camera camera = frame_asset(asset.view(), 45, 120, 90);
        both.expect_agreement(orbit(camera, 170));
        for (const TermSet shown : {TermSet::all, TermSet::multiple, TermSet::single,
                                    TermSet::specular, TermSet::diffuse}) {
            SCOPED_TRACE(testing::Message() << "components " << formats::term_names(shown));
            const GlRenderOptions options{.terms = shown, .background = false};
            if (terms == 1 && shown == TermSet::single) {
                for (const Rgb c : both.on_gl(camera, options).pixel)
                    EXPECT_EQ(c, Rgb{});  // it has no such rows
            } else {
                both.expect_agreement(camera, options);
            }
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
