#include <gtest/gtest.h>

#include <cmath>

#include "runtime/picture/camera.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/volumes/volume_march.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;
using formats::Vec3;

using test::kSize;

constexpr std::uint32_t kWidth = 40, kHeight = 30;

// Smoke 1.6 m wide around the origin, at most 1 optical depth a metre.
test::TestVolume smoke() {
    test::TestVolume volume = test::smoke_ball();
    volume.to_world = {0.05f, 0, 0, -0.8f, 0, 0.05f, 0, -0.8f, 0, 0, 0.05f, -0.8f};
    volume.sigma_t = {1, 2, 4};
    volume.albedo = {0.9f, 0.8f, 0.7f};
    return volume;
}

// A square wall at distance z behind the origin, of radiance 1 where the smoke is not.
Asset wall_at(float z) {
    Asset asset = test::make_asset(kSize, 16);
    test::add_bare_primitive(asset, test::make_sheet({0, 0, z}, {0.5f, 0, 0}, {0, 0.5f, 0}, 1, 1));
    asset.volumes = test::make_volumes(kSize);
    test::add_volume(asset.volumes, smoke());
    return asset;
}

Camera camera() {
    return {.eye = {0, 0, 4}, .fov_y = 30, .width = kWidth, .height = kHeight, .near_plane = 0.1f};
}

const formats::Environment kSky = tests::lat_long_map(64, 32, [](Vec3 d) {
    return Rgb{1 + 0.5f * d.x, 1, 1 - 0.5f * d.y};
});

struct Pictures {
    Picture with, without;
};

Pictures draw(const Asset& asset, bool background = true, unsigned threads = 0) {
    const std::vector<Rgb> radiance(asset.position.size(), {1, 1, 1});
    const auto view = asset.view();
    const VolumeLight light = relight_volumes(view.volumes, test::white_light(kSize));
    SoftwareOptions options;
    options.background = background;
    options.threads = threads;
    auto without = render_software(view, radiance, kSky, {}, camera(), options);
    options.volumes = &light;
    auto with = render_software(view, radiance, kSky, {}, camera(), options);
    EXPECT_TRUE(with && without);
    return {std::move(with).value(), std::move(without).value()};
}

// What the smoke does to the pixel's centre, up to the distance `depth` along the axis.
MarchResult smoke_at(const Asset& asset, std::uint32_t x, std::uint32_t y, double depth) {
    const auto view = asset.view();
    const VolumeLight light = relight_volumes(view.volumes, test::white_light(kSize));
    const Camera at = camera();
    const CameraFrame frame = camera_frame(at);
    const Vec3 ray = view_ray(at, frame, x + 0.5, y + 0.5);
    return march_volumes(light_volumes(view.volumes, light),
                         {at.eye, ray, 0, depth / -static_cast<double>(dot(ray, frame.backward))});
}

std::size_t pixel(std::uint32_t x, std::uint32_t y) {
    return std::size_t{y} * kWidth + x;
}

void expect_near(Rgb found, Rgb expected) {
    EXPECT_NEAR(found.r, expected.r, 2e-3);
    EXPECT_NEAR(found.g, expected.g, 2e-3);
    EXPECT_NEAR(found.b, expected.b, 2e-3);
}

TEST(VolumePicture, AWallInFrontHidesTheSmoke) {
    const Asset asset = wall_at(1.5f);
    const Pictures drawn = draw(asset);
    EXPECT_EQ(drawn.with.pixel[pixel(20, 15)], drawn.without.pixel[pixel(20, 15)]);
    EXPECT_EQ(drawn.with.pixel[pixel(20, 18)], drawn.without.pixel[pixel(20, 18)]);
}

TEST(VolumePicture, AWallBehindIsDimmedAndOneInsideCutsTheSmoke) {
    for (const float z : {-2.0f, 0.1f}) {
        const Asset asset = wall_at(z);
        const Pictures drawn = draw(asset);
        for (const auto& [x, y] : {std::pair{20u, 15u}, {21u, 13u}}) {
            const MarchResult seen = smoke_at(asset, x, y, 4 - static_cast<double>(z));
            EXPECT_LT(seen.transmittance.b, 0.6f);
            expect_near(drawn.with.pixel[pixel(x, y)],
                        seen.radiance + seen.transmittance * drawn.without.pixel[pixel(x, y)]);
        }
    }
}

TEST(VolumePicture, TheSkyIsSeenThroughItAndABlackBackgroundToo) {
    const Asset asset = wall_at(-2);
    for (const bool background : {true, false}) {
        const Pictures drawn = draw(asset, background);
        double most = 0;
        for (std::uint32_t y = 0; y < kHeight; ++y) {
            for (std::uint32_t x = 0; x < kWidth; ++x) {
                const MarchResult seen = smoke_at(asset, x, y, 100);
                const Rgb expected =
                    seen.radiance + seen.transmittance * drawn.without.pixel[pixel(x, y)];
                most = std::max(most, std::abs(static_cast<double>(drawn.with.pixel[pixel(x, y)].g -
                                                                   expected.g)));
            }
        }
        EXPECT_LT(most, 0.01);
        EXPECT_EQ(drawn.with.pixel[0], drawn.without.pixel[0]);
    }
}

TEST(VolumePicture, AnAssetOfVolumesAloneIsFramedAndDrawn) {
    Asset asset = test::make_asset(kSize, 16);
    asset.volumes = test::make_volumes(kSize);
    test::add_volume(asset.volumes, smoke());
    const auto view = asset.view();
    const BoundingSphere bound = bound_asset(view);
    // Density stands at voxels 2 to 30; the box goes from voxel 1 to voxel 31.
    EXPECT_NEAR(bound.x, 0, 1e-6);
    EXPECT_NEAR(bound.radius, 0.75 * std::sqrt(3.0), 1e-5);
    EXPECT_EQ(bound_object(view).radius, bound.radius);
    const Camera framed = frame_asset(view, 40, kWidth, kHeight);
    const VolumeLight light = relight_volumes(view.volumes, test::white_light(kSize));
    SoftwareOptions options;
    options.background = false;
    options.volumes = &light;
    const auto picture = render_software(view, {}, kSky, {}, framed, options);
    ASSERT_TRUE(picture);
    EXPECT_GT(picture->pixel[pixel(kWidth / 2, kHeight / 2)].r, 0.3f);
    EXPECT_EQ(picture->pixel[0], Rgb{});
    VolumeLight wrong;
    options.volumes = &wrong;
    EXPECT_FALSE(render_software(view, {}, kSky, {}, framed, options));
}

TEST(VolumePicture, AGroundThatDwarfsTheSmokeDoesNotCount) {
    Asset asset = test::make_asset(kSize, 16);
    test::add_bare_primitive(asset, test::make_sheet({0, -1, 0}, {0, 0, 20}, {20, 0, 0}, 1, 1));
    asset.volumes = test::make_volumes(kSize);
    test::add_volume(asset.volumes, smoke());
    EXPECT_NEAR(bound_object(asset.view()).radius, 0.75 * std::sqrt(3.0), 1e-5);
    EXPECT_GT(bound_asset(asset.view()).radius, 20);
}

}  // namespace
}  // namespace opaline::runtime
