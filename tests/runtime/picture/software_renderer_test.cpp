#include "runtime/picture/software_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/texture.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Environment;
using formats::Rgb;
using formats::Vec3;

Camera camera_at(Vec3 eye, Vec3 target, std::uint32_t width, std::uint32_t height, float fov) {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.width = width;
    camera.height = height;
    camera.fov_y = fov;
    camera.near_plane = 0.01f;
    return camera;
}

Picture draw(const Asset& asset, const std::vector<Rgb>& radiance, const Environment& environment,
             const Camera& camera, const Rotation& rotation = {},
             const SoftwareOptions& options = {}) {
    auto picture = render_software(asset.view(), radiance, environment, rotation, camera, options);
    EXPECT_TRUE(picture.has_value());
    return picture ? std::move(picture).value() : Picture{};
}

Rgb at(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    return picture.pixel[std::size_t{y} * picture.width + x];
}

// Column and row of the brightest pixel.
std::pair<std::uint32_t, std::uint32_t> brightest(const Picture& picture) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < picture.pixel.size(); ++i) {
        if (luminance(picture.pixel[i]) > luminance(picture.pixel[best])) best = i;
    }
    return {static_cast<std::uint32_t>(best % picture.width),
            static_cast<std::uint32_t>(best / picture.width)};
}

Environment spot_toward(Vec3 direction) {
    return tests::lat_long_map(256, 128, [direction](Vec3 d) {
        const float value = dot(d, direction) > 0.995f ? 1.0f : 0.0f;
        return Rgb{value, value, value};
    });
}

TEST(Background, LightFromTheRightStandsOnTheRightAndLightFromAboveOnTop) {
    const Camera along_minus_z = camera_at({0, 0, 0}, {0, 0, -1}, 121, 121, 100);
    // 30 degrees off the axis: tan 30 / tan 50 of the half width from the centre.
    const double off = 60.5 * std::tan(std::numbers::pi / 6) / std::tan(5 * std::numbers::pi / 18);
    const auto right = brightest(
        draw({}, {}, spot_toward(normalize(Vec3{1, 0, -std::sqrt(3.0f)})), along_minus_z));
    EXPECT_NEAR(right.first, 60 + off, 5);  // the spot's radius is 4 pixels
    EXPECT_NEAR(right.second, 60, 5);
    const auto top = brightest(
        draw({}, {}, spot_toward(normalize(Vec3{0, 1, -std::sqrt(3.0f)})), along_minus_z));
    EXPECT_NEAR(top.first, 60, 5);
    EXPECT_NEAR(top.second, 60 - off, 5);
}

TEST(Background, TurnsWithTheLightFromZTowardX) {
    const Environment front = spot_toward({0, 0, 1});
    const Camera toward_x = camera_at({0, 0, 0}, {1, 0, 0}, 61, 61, 60);
    const auto seen =
        brightest(draw({}, {}, front, toward_x, rotation_about_y(std::numbers::pi_v<float> / 2)));
    EXPECT_NEAR(seen.first, 30, 4);
    EXPECT_NEAR(seen.second, 30, 4);
}

TEST(Background, CubeAndLatLongOfTheSameSkyLookAlike) {
    const Camera camera = camera_at({0, 0, 0}, {0.6f, 0.3f, -1}, 80, 60, 90);
    const Picture a = draw({}, {}, tests::lat_long_map(512, 256, test::two_lights), camera);
    const Picture b = draw({}, {}, tests::cube_map(128, test::two_lights), camera);
    for (std::size_t i = 0; i < a.pixel.size(); ++i) {
        // Bilinear interpolation of a smooth sky over texels of 0.7 degrees.
        EXPECT_NEAR(a.pixel[i].r, b.pixel[i].r, 2e-3f * (1 + a.pixel[i].r));
        EXPECT_NEAR(a.pixel[i].b, b.pixel[i].b, 2e-3f * (1 + a.pixel[i].b));
    }
}

TEST(Background, SunIsADiscOfItsOwnSize) {
    Environment sun;
    sun.discs.push_back({{0, 0, -1}, 0.1f, {2, 2, 2}});
    const Picture picture = draw({}, {}, sun, camera_at({0, 0, 0}, {0, 0, -1}, 200, 200, 30));
    double area = 0;
    for (const Rgb pixel : picture.pixel) {
        area += static_cast<double>(pixel.g) / 2;
    }
    const double radius = 100 * std::tan(0.1) / std::tan(std::numbers::pi / 12);
    EXPECT_NEAR(area / (std::numbers::pi * radius * radius), 1, 5e-3);  // 37 pixels, 3x3 samples
}

// A sheet that reaches behind the eye: every sample below the horizon must show the point that its
// ray meets, whose radiance is linear in position: perspective and near clipping at once.
TEST(Surfaces, PlaneThroughTheEyesFeetIsSeenInExactPerspective) {
    Asset asset = test::make_asset(8, 8);
    const test::TestMesh sheet = test::make_sheet({0, 0, 0}, {40, 0, 0}, {0, 0, -40}, 1, 1);
    test::add_bare_primitive(asset, sheet);
    std::vector<Rgb> radiance;
    for (const Vec3 p : sheet.position) {
        radiance.push_back({p.x + 50, p.z + 50, 1});
    }
    asset.base_color.assign(asset.position.size(), {1, 1, 1});
    const Camera camera = camera_at({1, 1.5f, 3}, {2, 0.7f, -4}, 90, 70, 70);
    SoftwareOptions options;
    options.supersampling = 1;
    const Picture picture = draw(asset, radiance, {}, camera, {}, options);
    const CameraFrame frame = camera_frame(camera);
    std::uint32_t seen = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const Vec3 ray = view_ray(camera, frame, x + 0.5, y + 0.5);
            const float t = -camera.eye.y / ray.y;
            const Vec3 hit = camera.eye + t * ray;
            const bool meets = t > 0 && std::abs(hit.x) < 40 && std::abs(hit.z) < 40;
            const Rgb pixel = at(picture, x, y);
            if (std::abs(std::max(std::abs(hit.x), std::abs(hit.z)) - 40) < 0.01f) continue;
            EXPECT_EQ(pixel.b > 0, meets) << x << " " << y;
            if (meets) {
                ++seen;
                EXPECT_NEAR(pixel.r, hit.x + 50, 5e-3f);  // single precision of the ray
                EXPECT_NEAR(pixel.g, hit.z + 50, 5e-3f);
            }
        }
    }
    EXPECT_GT(seen, picture.pixel.size() / 3);
    EXPECT_LT(seen, picture.pixel.size());
}

TEST(Surfaces, ClosedMeshSeenFromInsideHasNoHoles) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sphere({0, 0, 0}, 1.0f, 37, 23));
    asset.primitives[0].flags = formats::PrimitiveRecord::kDoubleSided;
    asset.base_color.assign(asset.position.size(), {1, 1, 1});
    const std::vector<Rgb> radiance(asset.position.size(), {1, 1, 1});
    const Picture picture =
        draw(asset, radiance, {}, camera_at({0.3f, 0.2f, -0.5f}, {1, 0.1f, 1}, 160, 120, 110));
    for (const Rgb pixel : picture.pixel) {
        // One is the sum of weights that are rounded to floats.
        EXPECT_NEAR(pixel.g, 1.0f, 1e-6f);
    }
}

TEST(Surfaces, NearerOneHidesTheFartherInAnyOrder) {
    const test::TestMesh near_sheet = test::make_sheet({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 3, 1);
    const test::TestMesh far_sheet = test::make_sheet({0, 0, 0}, {5, 0, 0}, {0, 5, 0}, 1, 1);
    for (const bool near_first : {true, false}) {
        Asset asset = test::make_asset(8, 8);
        test::add_bare_primitive(asset, near_first ? near_sheet : far_sheet);
        test::add_bare_primitive(asset, near_first ? far_sheet : near_sheet);
        std::vector<Rgb> radiance;
        for (const Vec3 p : asset.position) {
            radiance.push_back(p.z > 0.5f ? Rgb{1, 0, 0} : Rgb{0, 1, 0});
        }
        const Picture picture =
            draw(asset, radiance, {}, camera_at({0, 0, 6}, {0, 0, 0}, 50, 50, 40));
        EXPECT_NEAR(at(picture, 25, 25).r, 0.8f, 1e-6f);
        EXPECT_EQ(at(picture, 25, 25).g, 0.0f);
        EXPECT_NEAR(at(picture, 3, 3).g, 0.8f, 1e-6f);
    }
}

// A black sheet before a white sky; its mean is what is seen of the sky.
TEST(Surfaces, AreSeenWhereTheyHaveNoHoles) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sheet({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 2, 1));
    asset.images.push_back({2, 1, {0, 0, 0, 255, 255, 255}});
    const std::vector<Rgb> radiance(asset.position.size());
    const Environment sky = tests::lat_long_map(8, 4, [](Vec3) { return Rgb{1, 1, 1}; });
    const Camera camera = camera_at({0, 0, 2}, {0, 0, 0}, 32, 16, 0.5f);
    const auto seen_sky = [&](const formats::HoleRecord& hole) {
        asset.holes.record = {hole};
        const Picture picture = draw(asset, radiance, sky, camera);
        double sum = 0;
        for (const Rgb& c : picture.pixel)
            sum += static_cast<double>(c.g);
        return sum / static_cast<double>(picture.pixel.size());
    };
    using formats::HoleMode, formats::Wrap;
    const formats::HoleRecord mask{.image = 0, .wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp};
    EXPECT_NEAR(seen_sky(mask), 0.5, 0.02);  // alpha is one half in the middle of the sheet
    EXPECT_EQ(seen_sky({.image = 0, .cutoff = 0}), 0);
    EXPECT_EQ(seen_sky({.alpha = 0.4f}), 1);
    EXPECT_NEAR(seen_sky({.alpha = 0.3f, .mode = HoleMode::blend}), 0.7, 0.005);
    asset.holes.vertex_alpha.assign(asset.position.size(), 0.5f);
    EXPECT_NEAR(seen_sky({.alpha = 0.3f, .mode = HoleMode::blend}), 0.85, 0.005);
}

TEST(Surfaces, TopOfTheObjectIsOnTopOfThePicture) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sphere({0, 0, 0}, 1.0f, 32, 16));
    const std::vector<Rgb> radiance(asset.position.size(), {1, 1, 1});
    const Picture picture = draw(asset, radiance, {}, frame_asset(asset.view(), 40, 64, 64));
    EXPECT_GT(at(picture, 32, 8).r, at(picture, 32, 8).b);    // red pole
    EXPECT_LT(at(picture, 32, 56).r, at(picture, 32, 56).b);  // blue pole
}

TEST(Surfaces, TextureIsFilteredInLinearLight) {
    Asset asset = test::make_asset(8, 8);
    asset.images.push_back(test::make_noise_image(5, 7));
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {1, 0, 0}, {0, -1, 0}, 1, 1.7f),
                        {1, 4, 0, formats::Wrap::mirror, formats::Wrap::repeat, 0, 1, true});
    asset.base_color.assign(asset.position.size(), {1, 1, 1});
    const std::vector<Rgb> radiance(asset.position.size(), {1, 1, 1});
    Camera camera = camera_at({0, 0, 2}, {0, 0, 0}, 64, 64, 0);
    camera.fov_y = static_cast<float>(2 * std::atan(0.5) * 180 / std::numbers::pi);
    SoftwareOptions options;
    options.supersampling = 1;
    const Picture picture = draw(asset, radiance, {}, camera, {}, options);
    const formats::AssetView view = asset.view();
    for (std::uint32_t y = 0; y < 64; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            const formats::Float2 uv{1.7f * (static_cast<float>(x) + 0.5f) / 64,
                                     1.7f * (static_cast<float>(y) + 0.5f) / 64};
            const Rgb expected = sample_image_linear(view.images[0], uv, formats::Wrap::mirror,
                                                     formats::Wrap::repeat);
            EXPECT_NEAR(at(picture, x, y).r, expected.r, 1e-4f);  // uv to 1e-6 times texel contrast
            EXPECT_NEAR(at(picture, x, y).b, expected.b, 1e-4f);
        }
    }
}

TEST(Picture, IsTheSameForAnyNumberOfThreads) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sphere({0, 0, 0}, 1.0f, 32, 16));
    test::add_bare_primitive(asset, test::make_sheet({0, -1, 0}, {9, 0, 0}, {0, 0, -9}, 4, 1));
    std::vector<Rgb> radiance;
    for (const Vec3 n : asset.normal) {
        radiance.push_back({n.x + 1, n.y + 1, n.z + 1});
    }
    const Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    const Camera camera = frame_asset(asset.view(), 50, 97, 71);
    SoftwareOptions one, five;
    one.threads = 1;
    five.threads = 5;
    EXPECT_EQ(draw(asset, radiance, sky, camera, {}, one).pixel,
              draw(asset, radiance, sky, camera, {}, five).pixel);
}

TEST(Picture, EmptyAssetShowsTheEnvironmentAlone) {
    const Environment white = tests::lat_long_map(16, 8, [](Vec3) { return Rgb{1, 1, 1}; });
    for (const auto& [width, height] : {std::pair{1u, 1u}, std::pair{33u, 2u}}) {
        const Picture picture = draw({}, {}, white, frame_asset(Asset{}.view(), 40, width, height));
        ASSERT_EQ(picture.pixel.size(), std::size_t{width} * height);
        for (const Rgb pixel : picture.pixel) {
            EXPECT_NEAR(pixel.r, 1.0f, 1e-6f);
        }
    }
}

TEST(Picture, DamagedValuesNeverReachIt) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sphere({0, 0, 0}, 1.0f, 8, 6));
    std::vector<Rgb> radiance(asset.position.size(), {1, 1, 1});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const Camera camera = frame_asset(asset.view(), 40, 40, 40);
    radiance[20] = {nan, inf, -5};
    radiance[30] = {3e38f, 3e38f, 3e38f};
    asset.position[25] = {nan, 0, 0};
    asset.position[26] = {inf, 0, 0};
    asset.position[27] = {3e38f, -3e38f, 3e38f};
    for (const Rgb pixel : draw(asset, radiance, {}, camera).pixel) {
        for (const float value : {pixel.r, pixel.g, pixel.b}) {
            EXPECT_TRUE(std::isfinite(value) && value >= 0);
        }
    }
}

TEST(Picture, ImpossibleRequestsAreRefused) {
    const auto refuses = [](const Camera& camera, std::uint32_t supersampling) {
        SoftwareOptions options;
        options.supersampling = supersampling;
        const auto result = render_software(Asset{}.view(), {}, {}, {}, camera, options);
        return !result && result.error().kind == formats::ErrorKind::usage;
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(refuses(camera_at({0, 0, 1}, {0, 0, 0}, 0, 5, 40), 3));
    EXPECT_TRUE(refuses(camera_at({0, 0, 1}, {0, 0, 0}, 5, kMaxPictureSize + 1, 40), 3));
    EXPECT_TRUE(refuses(camera_at({0, 0, 1}, {0, 0, 0}, 5, 5, 180), 3));
    EXPECT_TRUE(refuses(camera_at({0, 0, 1}, {0, 0, 0}, 5, 5, nan), 3));
    EXPECT_TRUE(refuses(camera_at({0, nan, 1}, {0, 0, 0}, 5, 5, 40), 3));
    EXPECT_TRUE(refuses(camera_at({0, 0, 1}, {0, 0, 0}, 5, 5, 40), 0));
    EXPECT_TRUE(refuses(camera_at({0, 0, 1}, {0, 0, 0}, 5, 5, 40), 9));
    EXPECT_FALSE(refuses(camera_at({0, 0, 1}, {0, 0, 0}, 5, 5, 40), 3));
}

TEST(Surfaces, OfOneSideAreNotDrawnFromBehind) {
    for (const bool is_double_sided : {false, true}) {
        Asset asset = test::make_asset(8, 8);
        test::add_primitive(asset, test::make_sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1),
                            {.is_double_sided = is_double_sided});
        const std::vector<Rgb> red(asset.position.size(), Rgb{1, 0, 0});
        asset.base_color.assign(asset.position.size(), Rgb{1, 1, 1});
        const Environment green = tests::lat_long_map(8, 4, [](Vec3) { return Rgb{0, 1, 0}; });
        for (const float side : {1.0f, -1.0f}) {
            const Picture picture =
                draw(asset, red, green, camera_at({0, 0, 3 * side}, {0, 0, 0}, 5, 5, 20));
            const bool is_seen = is_double_sided || side > 0;
            EXPECT_EQ(at(picture, 2, 2), (is_seen ? Rgb{1, 0, 0} : Rgb{0, 1, 0}))
                << is_double_sided << side;
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
