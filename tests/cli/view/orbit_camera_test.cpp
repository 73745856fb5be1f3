#include "bake/cli/view/view_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace opaline::cli {
namespace {

using formats::Vec3;

constexpr Viewpoint kFront{{1, 2, 8}, {1, 2, 3}};

void expect_near(Vec3 a, Vec3 b, float tolerance) {
    EXPECT_LT(length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

// A point of the scene in the camera's frame, x right, y up, z toward the viewer.
Vec3 in_frame_of(const Viewpoint& from, Vec3 point) {
    const runtime::CameraFrame frame = runtime::camera_frame(camera_of({}, from));
    const Vec3 d = point - from.target;
    return {dot(frame.right, d), dot(frame.up, d), dot(frame.backward, d)};
}

TEST(OrbitLevel, TurnsRightAndUpAroundTheTarget) {
    expect_near(orbit_level(kFront, 90, 0).eye, {6, 2, 3}, 1e-5f);
    expect_near(orbit_level(kFront, 0, 30).eye, {1, 4.5f, 3 + 5 * std::sqrt(0.75f)}, 1e-5f);
    const Viewpoint back = orbit_level(orbit_level(kFront, 70, 20), -70, -20);
    expect_near(back.eye, kFront.eye, 1e-5f);
    EXPECT_EQ(back.target, kFront.target);
}

TEST(OrbitLevel, StopsShortOfThePoles) {
    for (const double up : {500.0, -500.0}) {
        const Viewpoint pole = orbit_level(kFront, 0, up);
        EXPECT_NEAR(length(pole.eye - pole.target), 5, 1e-4);
        expect_near(orbit_level(pole, 10, 0).up, {0, 1, 0}, 1e-6f);
        const Vec3 away = pole.eye - pole.target;
        EXPECT_NEAR(std::hypot(away.x, away.z), 5 * std::sin(0.1 * std::numbers::pi / 180), 1e-4);
    }
}

// What lies on the unit ball under the mouse follows it.
TEST(TurnBall, TakesWhatItHoldsToWhereItIsDragged) {
    const BallPoint begin{0.2, -0.3}, end{-0.4, 0.5};
    const auto lift = [](BallPoint p) {
        return Vec3{float(p.x), float(p.y), float(std::sqrt(1 - p.x * p.x - p.y * p.y))};
    };
    const Viewpoint start = orbit_level(kFront, 33, 21);
    const runtime::CameraFrame frame = runtime::camera_frame(camera_of({}, start));
    const Vec3 held = lift(begin);
    const Vec3 in_scene =
        start.target + held.x * frame.right + held.y * frame.up + held.z * frame.backward;
    expect_near(in_frame_of(turn_ball(start, begin, end), in_scene), lift(end), 1e-5f);
}

TEST(TurnBall, GoesBackTheSameWayAndKeepsTheDistance) {
    for (const BallPoint end : {BallPoint{0.5, 0.1}, BallPoint{3, -2}, BallPoint{0.7, 0.72}}) {
        const Viewpoint there = turn_ball(kFront, {0.1, 0.1}, end);
        EXPECT_NEAR(length(there.eye - there.target), 5, 1e-5);
        const Viewpoint back = turn_ball(there, end, {0.1, 0.1});
        expect_near(back.eye, kFront.eye, 1e-5f);
        expect_near(back.up, {0, 1, 0}, 1e-5f);
    }
    expect_near(turn_ball(kFront, {0.3, 0.3}, {0.3, 0.3}).eye, kFront.eye, 1e-6f);
}

// Outside of the ball the scene rolls: a quarter turn about the line of sight at most.
TEST(TurnBall, FarOutsideRollsThePicture) {
    const Viewpoint rolled = turn_ball(kFront, {1e4, 0}, {0, 1e4});
    expect_near(rolled.eye, kFront.eye, 1e-3f);
    expect_near(rolled.up, {1, 0, 0}, 1e-3f);
}

TEST(Pan, MovesThePlaneOfTheTargetByItsShareOfTheHeight) {
    const float fov = 40;
    const Viewpoint moved = pan(kFront, fov, 0.25, -0.5);
    const float height = 2 * 5 * std::tan(fov / 2 * float(std::numbers::pi) / 180);
    // The old target is seen a quarter of the height to the right and half of it down.
    expect_near(in_frame_of(moved, kFront.target), {0.25f * height, -0.5f * height, 0}, 1e-5f);
    EXPECT_NEAR(length(moved.eye - moved.target), 5, 1e-5);
}

TEST(Zoom, ScalesTheDistanceWithinBounds) {
    expect_near(zoom(kFront, 0.5).eye, {1, 2, 5.5f}, 1e-6f);
    Viewpoint near = kFront;
    for (int i = 0; i < 200; ++i) {
        near = zoom(near, 0.5);
    }
    EXPECT_NEAR(length(near.eye - near.target), 3e-5f, 2e-6f);
}

// There is no direction to go along.
TEST(Zoom, OfAnEyeInItsTargetIsFinite) {
    const Viewpoint moved = zoom({.eye = {1, 2, 3}, .target = {1, 2, 3}, .up = {0, 1, 0}}, 2);
    EXPECT_TRUE(std::isfinite(length(moved.eye)));
}

TEST(BallPoint, ShorterSideSpansTheBall) {
    const BallPoint corner = ball_point(800, 0, 800, 400);
    EXPECT_DOUBLE_EQ(corner.x, 2);
    EXPECT_DOUBLE_EQ(corner.y, 1);
    EXPECT_DOUBLE_EQ(ball_point(400, 200, 800, 400).x, 0);
}

}  // namespace
}  // namespace opaline::cli
