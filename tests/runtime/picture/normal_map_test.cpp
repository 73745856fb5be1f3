// Normal maps in pictures of the software renderer.
#include "runtime/normal_maps/turned_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/picture/software_renderer.h"
#include "runtime/shade.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;
using formats::Vec3;

// Seen from above: a sheet in the plane y = 0 that fills the picture; u toward +X, v toward -Z.
Camera from_above() {
    Camera camera;
    camera.eye = {0, 3, 0.01f};
    camera.target = {0, 0, 0};
    camera.width = camera.height = 24;
    camera.fov_y = 20;
    return camera;
}

Asset sheet_of(const formats::PreviewImageData& map, float scale, Vec3 along, float sign) {
    Asset asset = test::make_asset(32, 16);
    asset.images.push_back(map);
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, 4, 3),
                        {.bands = 1, .details = 1000});
    test::add_normal_map(asset, {.primitive = 0, .image = 0, .scale = scale}, along, sign);
    return asset;
}

Picture draw(const Asset& asset, const formats::Environment& environment) {
    const formats::AssetView view = asset.view();
    const LightVector light = project_environment(environment, view.cubemap_size);
    const Camera camera = from_above();
    SoftwareOptions options;
    options.lights = light;
    auto picture =
        render_software(view, shade_for_picture(view, light, camera.eye, formats::TermSet::all, 1),
                        environment, {}, camera, options);
    EXPECT_TRUE(picture);
    return std::move(picture).value();
}

Rgb middle(const Picture& picture) {
    return picture.pixel[picture.pixel.size() / 2 + picture.width / 2];
}

formats::Environment sun(Vec3 direction) {
    formats::Environment environment;
    environment.discs.push_back({direction, 0.005f, {1e4f, 1e4f, 1e4f}});
    return environment;
}

TEST(NormalMap, FlatOneChangesNothing) {
    const auto flat = test::make_even_normals({0, 0, 1});
    ASSERT_EQ(flat.rgb, (std::vector<std::uint8_t>{128, 128, 255}));
    for (const auto& light :
         {sun(normalize(Vec3{1, 1, 0.5f})), tests::lat_long_map(64, 32, test::two_lights)}) {
        Asset asset = sheet_of(flat, 1, {1, 0, 0}, 1);
        const Picture with = draw(asset, light);
        asset.normal_maps = {};
        const Picture without = draw(asset, light);
        for (std::size_t i = 0; i < with.pixel.size(); ++i) {
            EXPECT_NEAR(with.pixel[i].r, without.pixel[i].r, 1e-6f * without.pixel[i].r);
        }
    }
}

TEST(NormalMap, OfScaleZeroOrWithoutTangentsChangesNothing) {
    const auto light = sun(normalize(Vec3{1, 1, 0.5f}));
    const auto steep = test::make_even_normals(normalize(Vec3{0.5f, 0.3f, 1}));
    Asset plain = sheet_of(steep, 1, {1, 0, 0}, 1);
    plain.normal_maps = {};
    const float expected = middle(draw(plain, light)).r;
    EXPECT_NEAR(middle(draw(sheet_of(steep, 0, {1, 0, 0}, 1), light)).r, expected,
                1e-6f * expected);
    EXPECT_NEAR(middle(draw(sheet_of(steep, 1, {1, 0, 0}, 0), light)).r, expected,
                1e-6f * expected);
    EXPECT_GT(std::abs(middle(draw(sheet_of(steep, 1, {1, 0, 0}, 1), light)).r - expected),
              0.1f * expected);
}

TEST(NormalMap, TiltedEvenlyByTwentyDegreesHasTheCosineOfASun) {
    const float sine = std::sin(std::numbers::pi_v<float> / 9);
    const auto map = test::make_even_normals({sine, 0, std::sqrt(1 - sine * sine)});
    const Vec3 coded = test::coded_normal(map);
    for (const float azimuth : {0.0f, 1.5f, 3.0f}) {
        const Vec3 toward =
            formats::normalize({std::cos(azimuth), 1.2f, std::sin(azimuth)});  // 40 degrees off
        for (const float side : {1.0f, -1.0f}) {  // the image mirrored in u, or not
            Asset asset = sheet_of(map, 1, {side, 0, 0}, side);
            const float tilted = middle(draw(asset, sun(toward))).g;
            asset.normal_maps = {};
            const float flat = middle(draw(asset, sun(toward))).g;
            const Vec3 normal{side * coded.x, coded.z, 0};
            EXPECT_NEAR(tilted / flat, dot(normal, toward) / toward.y, 0.01f) << azimuth;
        }
    }
}

TEST(NormalMap, GreenPointsUpInTheImageMirroredOrNot) {
    const auto map = test::make_even_normals(normalize(Vec3{0, 0.6f, 1}));
    // v grows toward -Z on the sheet (make_sheet), so that up in the image is +Z.
    for (const float side : {1.0f, -1.0f}) {
        Asset asset = sheet_of(map, 1, {side, 0, 0}, -side);
        const float front = middle(draw(asset, sun(normalize(Vec3{0, 1, 1})))).g;
        const float back = middle(draw(asset, sun(normalize(Vec3{0, 1, -1})))).g;
        EXPECT_GT(front, 2 * back);
    }
}

TEST(NormalMap, ScaleTiltsByItsTangent) {
    const auto map = test::make_even_normals(normalize(Vec3{0.3f, 0, 1}));
    const Vec3 coded = test::coded_normal(map);
    const Asset asset = sheet_of(map, 2, {1, 0, 0}, 1);
    const Vec3 normal = mapped_normal(asset.view(), asset.normal_maps.record[0], {0.3f, 0.4f},
                                      {0, 1, 0}, {{1, 0, 0}, 1});
    EXPECT_NEAR(normal.x / normal.y, 2 * coded.x / coded.z, 1e-5f);
    EXPECT_NEAR(length(normal), 1, 1e-6f);
}

TEST(NormalMap, NormalThatTurnsAwayIsBentTowardTheEye) {
    const ViewOfReceiver view{{0, 1, 0}, normalize(Vec3{1, 0.3f, 0}), 0.2873f, false};
    const ViewOfReceiver bent = view_mapped(view, normalize(Vec3{-1, 1, 0}));
    EXPECT_NEAR(bent.cosine, dot(bent.normal, view.to_eye), 1e-6f);
    EXPECT_GT(bent.cosine, 0.03f);
    EXPECT_LT(bent.cosine, 0.06f);
    const ViewOfReceiver facing = view_mapped(view, view.to_eye);
    EXPECT_NEAR(facing.cosine, 1, 1e-6f);
    // The back of a surface with two sides has the map's other side.
    const ViewOfReceiver back{{0, -1, 0}, {0, -1, 0}, 1, true};
    EXPECT_LT(view_mapped(back, normalize(Vec3{0.2f, 1, 0})).normal.y, -0.9f);
}

}  // namespace
}  // namespace opaline::runtime
