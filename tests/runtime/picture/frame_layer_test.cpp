#include "runtime/picture/frame_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

formats::LayerRecord wide_layer() {
    formats::LayerRecord layer;
    layer.base = 1200;
    layer.ground = 200;
    layer.center = {300, -500};
    layer.size = {20000, 10000};
    return layer;
}

double degrees_up(const Camera& camera) {
    const formats::Vec3 d = camera.target - camera.eye;
    return std::asin(static_cast<double>(d.y / length(d))) * 180 / std::numbers::pi;
}

TEST(FrameLayer, LooksUpFromTheGroundAtTheBase) {
    const Camera camera = frame_layer(wide_layer(), 32, 40, 30);
    EXPECT_NEAR(camera.eye.y, 201.7f, 1e-3f);
    EXPECT_EQ(camera.eye.x, 300);
    EXPECT_EQ(camera.target.y, 1200);
    EXPECT_GT(degrees_up(camera), 12);  // it ends 5 km away
    EXPECT_NEAR(std::hypot(camera.target.x - 300, camera.target.z + 500), 2500, 1);
    formats::LayerRecord endless = wide_layer();
    endless.flags = formats::LayerRecord::kRepeat;
    EXPECT_NEAR(degrees_up(frame_layer(endless, 32, 40, 30)), 12, 0.01);
}

TEST(FrameLayer, StaysAboveTheGroundBeneathFog) {
    formats::LayerRecord fog = wide_layer();
    fog.base = 200.5f;
    const Camera camera = frame_layer(fog, 32, 40, 30);
    EXPECT_GT(camera.eye.y, 200);
    EXPECT_LT(camera.eye.y, 200.5f);
}

TEST(FrameLayer, IsTheDefaultOfALayerAloneAndItsNearPlaneHidesNoCloud) {
    formats::Asset asset = test::make_asset(8, 8);
    asset.clouds.records.push_back(wide_layer());
    EXPECT_EQ(frame_asset(asset.view(), 32, 40, 30).eye, frame_layer(wide_layer(), 32, 40, 30).eye);
    EXPECT_EQ(near_plane_for(asset.view(), {1e5f, 1300, 0}), kLayerNearPlane);
    test::add_bare_primitive(asset, test::make_sphere({0, 202, 0}, 1.0f, 24, 12));
    const Camera meshes = frame_asset(asset.view(), 32, 40, 30);
    EXPECT_LT(length(meshes.eye - formats::Vec3{0, 202, 0}), 5);
    EXPECT_LE(near_plane_for(asset.view(), {0, 1e4f, 0}), kLayerNearPlane);
}

}  // namespace
}  // namespace opaline::runtime
