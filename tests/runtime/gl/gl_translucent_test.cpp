#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/view_terms.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Environment;
using formats::Rgb;
using test::BothRenderers;

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

// Among them grey media next to coloured ones.
TEST_F(GlTranslucent, PicturesAgreeWithTheCpuForEveryNumberOfTermsAndBands) {
    const Environment sky = tests::lat_long_map(128, 64, test::two_lights);
    struct TermsAndBands {
        std::uint32_t terms;
        float eta;
        std::uint32_t bands;
    };
    for (const auto& [terms, eta, bands] :
         {TermsAndBands{1, 1.3f, 3}, TermsAndBands{4, 0.7f, 3}, TermsAndBands{9, 1.0f, 3},
          TermsAndBands{25, 3.0f, 3}, TermsAndBands{1, 1.3f, 1}, TermsAndBands{4, 1.3f, 1}}) {
        SCOPED_TRACE(testing::Message()
                     << terms << " terms, eta " << eta << ", " << bands << " bands");
        const Asset asset = make_scene(terms, eta, bands);
        BothRenderers both(asset, sky, rotation_about_y(0.7f));
        // Twice around: the second view must not see the first one's sums.
        for (const float degrees : {0.0f, 160.0f}) {
            both.expect_agreement(orbit(frame_asset(asset.view(), 45, 120, 90), degrees));
        }
    }
}

// Seen from in front and from behind, beside a medium of as many rows.
TEST_F(GlTranslucent, PicturesOfThinWalledSurfacesAgreeWithTheCpu) {
    const Environment sky = tests::lat_long_map(128, 64, test::two_lights);
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
        BothRenderers both(asset, sky);
        for (const float degrees : {0.0f, 180.0f}) {
            both.expect_agreement(orbit(frame_asset(asset.view(), 45, 120, 90), degrees));
        }
    }
}

TEST_F(GlTranslucent, SeveralDispatchesMakeTheSamePicture) {
    const Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    const Asset asset = make_scene(4, 1.3f);
    for (const GlOptions& options : {GlOptions{1, 0}, GlOptions{32, 0}, GlOptions{4, 8192}}) {
        BothRenderers both(asset, sky, {}, options);
        EXPECT_EQ(both.renderer.stats().dispatches > asset.primitives.size(),
                  options.max_block_bytes != 0);
        both.expect_agreement(frame_asset(asset.view(), 45, 101, 67));
    }
}

TEST_F(GlTranslucent, ExtremeScalesAndViewsFromInsideAgree) {
    const Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    for (const float scale : {1e-12f, 1e12f}) {
        Asset asset = make_scene(4, 1.3f);
        for (formats::Vec3& p : asset.position) {
            p = scale * p;
        }
        BothRenderers both(asset, sky);
        Camera camera = frame_asset(asset.view(), 40, 120, 90);
        both.expect_agreement(camera);
        camera.eye = scale * formats::Vec3{0.1f, 1.1f, 0.3f};
        camera.target = scale * formats::Vec3{0, 1, 0};
        camera.near_plane = scale * 1.2f;  // beyond the sphere: the floor and the boards
        both.expect_agreement(camera);
    }
}

TEST_F(GlTranslucent, DamagedValuesNeverReachThePicture) {
    const Environment sky = tests::lat_long_map(32, 16, test::two_lights);
    Asset asset = make_scene(4, 1.3f);
    const Camera camera = frame_asset(asset.view(), 40, 60, 60);
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
    BothRenderers both(asset, sky);
    test::expect_displayable(both.on_gl(camera));
    test::expect_displayable(both.on_cpu(camera));
}

TEST_F(GlTranslucent, SpheresDarkenTowardTheirEdgeAsFresnelSays) {
    // White light and one term: radiance is base colour times Ft under a normal that turns away.
    const Environment white = tests::lat_long_map(64, 32, [](formats::Vec3) {
        return Rgb{1, 1, 1};
    });
    Asset asset = test::make_asset(16, 16);
    test::add_primitive(asset, test::make_sphere({0, 0, 0}, 1, 64, 40),
                        {.bands = 3, .details = 2000, .eta = 1.5f});
    std::ranges::fill(asset.base_color, Rgb{1, 1, 1});
    const Picture picture = BothRenderers(asset, white)
                                .on_gl({.eye = {0, 0, 1000},
                                        .fov_y = 0.14f,
                                        .width = 101,
                                        .height = 101,
                                        .near_plane = 900},
                                       {.supersampling = 1});
    const double half = 1000 * std::tan(0.07 * std::numbers::pi / 180);
    for (std::uint32_t x = 50; x < 101; ++x) {
        const double r = (x - 50) / 50.5 * half;
        if (r > 0.95) continue;  // facets of the silhouette
        const float cosine = static_cast<float>(std::sqrt(1 - r * r));
        EXPECT_NEAR(picture.pixel[std::size_t{50} * 101 + x].r, fresnel_transmittance(cosine, 1.5f),
                    6e-3)  // facets, 2000 details
            << "at radius " << r;
    }
}

using formats::TermSet;

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

using formats::GlossRecord;

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
