#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/picture/camera.h"
#include "runtime/picture/frame_layer.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Vec3;

constexpr float kDegrees = 180 / std::numbers::pi_v<float>;

struct Extent {
    double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
};

// Where the vertices land on the image plane, which spans [-1, 1] in both directions.
Extent project(const Camera& camera, std::span<const Vec3> positions) {
    const CameraFrame frame = camera_frame(camera);
    Extent extent;
    for (const Vec3 p : positions) {
        const Vec3 d = p - camera.eye;
        const double w = static_cast<double>(-dot(frame.backward, d));
        EXPECT_GT(w, static_cast<double>(camera.near_plane));
        const double x = static_cast<double>(dot(frame.right, d)) / w / frame.tan_half_x;
        const double y = static_cast<double>(dot(frame.up, d)) / w / frame.tan_half_y;
        extent = {std::min(extent.low_x, x), std::max(extent.high_x, x), std::min(extent.low_y, y),
                  std::max(extent.high_y, y)};
    }
    return extent;
}

void expect_usable(const Camera& camera) {
    for (const Vec3 v : {camera.eye, camera.target}) {
        EXPECT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
    }
    EXPECT_TRUE(std::isfinite(camera.near_plane));
    EXPECT_GT(camera.near_plane, 0.0f);
    EXPECT_FALSE(camera.eye == camera.target);
}

TEST(FrameAsset, ObjectFillsTheFrameAndTheFloorIsIgnored) {
    Asset asset = test::make_asset(8, 8);
    const test::TestMesh sphere = test::make_sphere({3, 1, -2}, 1.0f, 24, 12);
    test::add_bare_primitive(asset, test::make_sheet({0, 0, 0}, {50, 0, 0}, {0, 0, -50}, 2, 1));
    test::add_bare_primitive(asset, sphere);
    for (const auto& [width, height] : {std::pair{800u, 600u}, std::pair{300u, 900u}}) {
        const Camera camera = frame_asset(asset.view(), 40, width, height);
        const Extent seen = project(camera, sphere.position);
        EXPECT_LE(std::max({-seen.low_x, seen.high_x, -seen.low_y, seen.high_y}), 1.0);
        // The sphere touches the narrower side but for the margin of 4 %.
        EXPECT_GE(std::max(seen.high_x - seen.low_x, seen.high_y - seen.low_y), 2 * 0.93);
    }
}

TEST(FrameAsset, FloorMayLeanOrBeASlab) {
    const test::TestMesh sphere = test::make_sphere({0, 1, 0}, 1.0f, 24, 12);
    Asset leaning = test::make_asset(8, 8);
    test::add_bare_primitive(leaning, sphere);
    test::add_bare_primitive(leaning, test::make_sheet({0, 0, 0}, {20, 9, 0}, {0, 3, -20}, 2, 1));
    EXPECT_NEAR(bound_object(leaning.view()).radius, 1.0, 1e-5);

    Asset slab = test::make_asset(8, 8);
    test::TestMesh thin = test::make_sphere({0, 0, 0}, 1.0f, 8, 4);
    for (Vec3& p : thin.position) {
        p = {20 * p.x, 0.1f * p.y, 20 * p.z};
    }
    test::add_bare_primitive(slab, sphere);
    test::add_bare_primitive(slab, thin);
    EXPECT_NEAR(bound_object(slab.view()).radius, 1.0, 1e-5);
}

// Review 1, fault 25: a flat primitive as large as the others was left out of the frame.
TEST(FrameAsset, EverythingIsFramedButAGroundThatDwarfsIt) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sphere({0, 1, 0}, 1.0f, 24, 12));
    const test::TestMesh poster = test::make_sheet({2.5f, 1, 0}, {1, 0, 0}, {0, 1.5f, 0}, 2, 1);
    test::add_bare_primitive(asset, poster);
    EXPECT_EQ(bound_object(asset.view()).radius, bound_asset(asset.view()).radius);
    const Extent seen = project(frame_asset(asset.view(), 40, 640, 480), poster.position);
    EXPECT_LE(std::max({-seen.low_x, seen.high_x, -seen.low_y, seen.high_y}), 1.0);
}

TEST(FrameAsset, LooksAtFrontsNotAtBacks) {
    for (const float side : {1.0f, -1.0f}) {  // facing +Z, then -Z
        Asset asset = test::make_asset(8, 8);
        const test::TestMesh sheet = test::make_sheet({0, 0, 0}, {side, 0, 0}, {0, 1, 0}, 2, 1);
        test::add_bare_primitive(asset, sheet);
        const Vec3 face = cross(sheet.position[sheet.index[1]] - sheet.position[sheet.index[0]],
                                sheet.position[sheet.index[2]] - sheet.position[sheet.index[0]]);
        EXPECT_GT(face.z * side, 0);
        const Camera camera = frame_asset(asset.view(), 40, 640, 480);
        EXPECT_GT(dot(camera.eye - camera.target, face), 0) << side;
        EXPECT_EQ(front_share(asset.view(), face), 1);
        EXPECT_EQ(front_share(asset.view(), -1.0f * face), 0);
        asset.primitives[0].flags = formats::PrimitiveRecord::kDoubleSided;
        EXPECT_EQ(front_share(asset.view(), -1.0f * face), 1);
    }
}

TEST(FrameAsset, LoneSheetIsTheObject) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sheet({0, 0, 0}, {3, 0, 0}, {0, 0, -4}, 2, 1));
    EXPECT_NEAR(bound_object(asset.view()).radius, 5.0, 1e-5);
}

TEST(FrameAsset, LooksFromTheFrontRightAndAbove) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sphere({0, 0, 0}, 2.0f, 16, 8));
    const Camera camera = frame_asset(asset.view(), 30, 640, 480);
    const Vec3 d = normalize(camera.eye - camera.target);
    EXPECT_NEAR(std::atan2(d.x, d.z) * kDegrees, 30, 1e-3);
    EXPECT_NEAR(std::asin(d.y) * kDegrees, 10, 1e-3);
}

// A horizon, at elevation 0, is seen above the middle of the picture and below its top.
TEST(FrameAsset, HorizonIsInThePictureOfUprightThingsAndFlatOnesAreSeenFromAbove) {
    const auto elevation_of = [](Vec3 half) {
        Asset asset = test::make_asset(8, 8);
        test::TestMesh body = test::make_sphere({0, 0, 0}, 1.0f, 16, 8);
        for (Vec3& p : body.position)
            p = {half.x * p.x, half.y * p.y, half.z * p.z};
        test::add_bare_primitive(asset, body);
        const Camera camera = frame_asset(asset.view(), 32, 640, 480);
        const Extent seen = project(camera, body.position);
        EXPECT_LE(std::max({-seen.low_x, seen.high_x, -seen.low_y, seen.high_y}), 1.0);
        EXPECT_GE(std::max(seen.high_x - seen.low_x, seen.high_y - seen.low_y), 2 * 0.8);
        const Vec3 d = normalize(camera.eye - camera.target);
        return std::asin(d.y) * kDegrees;
    };
    EXPECT_LT(elevation_of({0.5f, 2, 0.5f}), 0.75f * 16);
    EXPECT_GT(elevation_of({2, 0.05f, 1.5f}), 20);
}

// Balls on a floor of 2.5 times their width took a third of the picture's.
TEST(FrameAsset, LevelGroundIsLeftOutWholeOrInTilesButABoardOnItIsNot) {
    for (const int tiles : {1, 3}) {
        Asset asset = test::make_asset(8, 8);
        test::add_bare_primitive(asset, test::make_sphere({0, 1, 0}, 1.0f, 24, 12));
        const float half = 2.5f / static_cast<float>(tiles);
        for (int i = 0; i < tiles * tiles; ++i) {
            const float x = half * static_cast<float>(2 * (i % tiles) - tiles + 1),
                        z = half * static_cast<float>(2 * (i / tiles) - tiles + 1);
            test::add_bare_primitive(
                asset, test::make_sheet({x, 0, z}, {half, 0, 0}, {0, 0, -half}, 2, 1));
        }
        EXPECT_NEAR(bound_object(asset.view()).radius, 1.0, 1e-5) << tiles;
        // A shelf above, as wide as that floor, is no ground.
        test::add_bare_primitive(asset,
                                 test::make_sheet({0, 4, 0}, {2.5f, 0, 0}, {0, 0, -2.5f}, 2, 1));
        EXPECT_GT(bound_object(asset.view()).radius, 3.0) << tiles;
    }
    Asset board = test::make_asset(8, 8);
    test::add_bare_primitive(board, test::make_sheet({0, 0, 0}, {9, 0, 0}, {0, 0, -9}, 2, 1));
    test::add_bare_primitive(board, test::make_sheet({0, 0.1f, 0}, {2, 0, 0}, {0, 0, -2}, 2, 1));
    test::add_bare_primitive(board, test::make_sphere({0, 0.6f, 0}, 0.5f, 24, 12));
    EXPECT_GT(bound_object(board.view()).radius, 2.8);
}

TEST(FrameAsset, IsDefinedForEmptyPointlikeTinyHugeAndDamagedAssets) {
    expect_usable(frame_asset(Asset{}.view(), 40, 640, 480));
    test::TestMesh point;
    point.position = {{1e6f, -3, 2}};
    point.normal = {{0, 1, 0}};
    point.base_color = {{1, 1, 1}};
    point.texcoord = {{0, 0}};
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, point);
    expect_usable(frame_asset(asset.view(), 40, 640, 480));
    for (const float scale : {1e-30f, 1e-10f, 1e10f, 3e38f}) {
        Asset scaled = test::make_asset(8, 8);
        test::TestMesh sphere = test::make_sphere({0, 0, 0}, 1.0f, 8, 4);
        for (Vec3& p : sphere.position) {
            p = scale * p;
        }
        test::add_bare_primitive(scaled, sphere);
        expect_usable(frame_asset(scaled.view(), 40, 640, 480));
    }
    asset.position[0].x = std::numeric_limits<float>::quiet_NaN();
    expect_usable(frame_asset(asset.view(), 40, 640, 480));
    EXPECT_EQ(bound_object(asset.view()).radius, 0.0);
}

TEST(CameraFrame, IsOrthonormalAndRightHandedForEveryView) {
    for (const Vec3 eye : {Vec3{3, 1, 2}, Vec3{0, 5, 0}, Vec3{0, -5, 0}, Vec3{0, 0, 0}}) {
        for (const Vec3 up : {Vec3{0, 1, 0}, Vec3{0, 0, 0}, Vec3{0, 0, 7}}) {
            Camera camera;
            camera.eye = eye;
            camera.up = up;
            const CameraFrame frame = camera_frame(camera);
            EXPECT_NEAR(length(frame.right), 1, 1e-6);
            EXPECT_NEAR(length(frame.up), 1, 1e-6);
            EXPECT_NEAR(dot(cross(frame.right, frame.up), frame.backward), 1, 1e-5);
        }
    }
}

TEST(ViewRay, CentreMeetsTheTargetAndTheTopEdgeIsHalfTheAngleOfViewAbove) {
    Camera camera;
    camera.eye = {4, 3, 2};
    camera.target = {-1, 0, 5};
    camera.fov_y = 50;
    camera.width = 300;
    camera.height = 200;
    const CameraFrame frame = camera_frame(camera);
    const Vec3 axis = normalize(camera.target - camera.eye);
    EXPECT_NEAR(dot(view_ray(camera, frame, 150, 100), axis), 1, 1e-6);
    const Vec3 top = view_ray(camera, frame, 150, 0);
    EXPECT_NEAR(std::acos(dot(top, axis)) * kDegrees, 25, 1e-2);
    EXPECT_GT(top.y, axis.y);
    // The right edge: to the right of somebody who looks along the axis with +Y up.
    EXPECT_GT(dot(view_ray(camera, frame, 300, 100), cross(axis, {0, 1, 0})), 0);
}

TEST(Orbit, TurnsFromZTowardXAtTheSameDistanceAndHeight) {
    Camera camera;
    camera.target = {1, 1, 1};
    camera.eye = {1, 3, 6};
    const Camera turned = orbit(camera, 90);
    EXPECT_NEAR(turned.eye.x, 6, 1e-5);
    EXPECT_NEAR(turned.eye.y, 3, 1e-5);
    EXPECT_NEAR(turned.eye.z, 1, 1e-5);
}

TEST(NearPlane, LeavesRoomBeforeTheAssetAndIsSmallInsideIt) {
    Asset asset = test::make_asset(8, 8);
    test::add_bare_primitive(asset, test::make_sphere({0, 0, 0}, 2.0f, 16, 8));
    EXPECT_LT(near_plane_for(asset.view(), {0, 0, 10}), 8.0f);
    EXPECT_GT(near_plane_for(asset.view(), {0, 0, 10}), 1.0f);
    EXPECT_NEAR(near_plane_for(asset.view(), {0, 0, 0}), 2e-3f, 1e-5f);
}

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
