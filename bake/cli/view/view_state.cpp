#include "bake/cli/view/view_state.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace opaline::cli {
namespace {

using formats::Vec3;

constexpr double kDegrees = 180 / std::numbers::pi;

runtime::CameraFrame frame_of(const Viewpoint& view) {
    runtime::Camera camera;
    camera.eye = view.eye;
    camera.target = view.target;
    camera.up = view.up;
    return runtime::camera_frame(camera);
}

// In the camera's frame: x right, y up, z toward the viewer.
Vec3 lift(BallPoint point) {
    const double squared = point.x * point.x + point.y * point.y;
    const double z = squared < 0.5 ? std::sqrt(1 - squared) : 0.5 / std::sqrt(squared);
    return formats::normalize(
        {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(z)});
}

// v turned by the rotation that takes unit a to unit b the short way; b = -a leaves v.
Vec3 turn(Vec3 v, Vec3 a, Vec3 b) {
    const Vec3 axis = cross(a, b);
    const float cosine = dot(a, b);
    if (1 + cosine < 1e-6f) return v;
    // Rodrigues' formula with |axis| = sin.
    return cosine * v + cross(axis, v) + (dot(axis, v) / (1 + cosine)) * axis;
}

}  // namespace

runtime::Camera camera_of(const ViewState& state, const Viewpoint& from) {
    runtime::Camera camera;
    camera.eye = from.eye;
    camera.target = from.target;
    camera.up = from.up;
    camera.fov_y = state.fov;
    camera.width = state.width;
    camera.height = state.height;
    return camera;
}

bool same_radiance(const ViewState& a, const ViewState& b) {
    const auto parts = [](const ViewState& s) {
        return std::tie(s.file, s.other, s.light, s.viewpoint, s.width, s.height, s.fov,
                        s.rotate_light, s.time, s.terms, s.coefficients, s.emitters, s.error_white);
    };
    return parts(a) == parts(b);
}

void rotate_light_to(ViewState& state, double degrees) {
    const double turned = std::fmod(degrees, 360.0);
    state.rotate_light = turned < 0 ? turned + 360.0 : turned;
    if (state.rotate_light >= 360.0) state.rotate_light = 0;  // of -1e-300
}

void set_emitter(ViewState& state, const std::string& name, formats::Rgb color) {
    std::erase_if(state.emitters,
                  [&](const EmitterColor& emitter) { return emitter.name == name; });
    if (color.r != 1.0f || color.g != 1.0f || color.b != 1.0f) {
        state.emitters.push_back({name, color});
    }
}

formats::Rgb emitter_color(const ViewState& state, const std::string& name) {
    for (const EmitterColor& emitter : state.emitters) {
        if (emitter.name == name) return emitter.color;
    }
    return {1, 1, 1};
}

void toggle_term(ViewState& state, formats::TermSet term) {
    state.terms = has_any(state.terms, term) ? state.terms & ~term : state.terms | term;
}

void show_file(ViewState& state, const std::string& path) {
    state.file = path;
    state.viewpoint.reset();
    state.coefficients.reset();
    state.terms = formats::TermSet::baked;
    state.emitters.clear();
    state.error_white = 0;
}

BallPoint ball_point(double column, double row, double width, double height) {
    const double half = 0.5 * std::max(1.0, std::min(width, height));
    return {(column - 0.5 * width) / half, (0.5 * height - row) / half};
}

Viewpoint orbit_level(const Viewpoint& from, double azimuth, double elevation) {
    constexpr double kMost = 89.9;
    const Vec3 away = from.eye - from.target;
    const double x = static_cast<double>(away.x), y = static_cast<double>(away.y),
                 z = static_cast<double>(away.z);
    const double at = std::atan2(x, z) * kDegrees + azimuth;
    const double above =
        std::clamp(std::atan2(y, std::hypot(x, z)) * kDegrees + elevation, -kMost, kMost);
    Viewpoint turned = level(from);
    turned.eye =
        from.target + static_cast<float>(std::hypot(x, y, z)) * runtime::view_direction(at, above);
    return turned;
}

Viewpoint turn_ball(const Viewpoint& from, BallPoint begin, BallPoint end) {
    const runtime::CameraFrame frame = frame_of(from);
    const auto to_world = [&](Vec3 v) {
        return v.x * frame.right + v.y * frame.up + v.z * frame.backward;
    };
    // The camera turns the other way than the scene does.
    const Vec3 a = to_world(lift(end)), b = to_world(lift(begin));
    return {from.target + turn(from.eye - from.target, a, b), from.target,
            normalize(turn(frame.up, a, b))};
}

Viewpoint pan(const Viewpoint& from, float fov, double right, double up) {
    const runtime::CameraFrame frame = frame_of(from);
    const double height = 2 * std::tan(static_cast<double>(fov) / kDegrees / 2) *
                          static_cast<double>(length(from.eye - from.target));
    const Vec3 step = static_cast<float>(-right * height) * frame.right +
                      static_cast<float>(-up * height) * frame.up;
    return {from.eye + step, from.target + step, from.up};
}

Viewpoint zoom(const Viewpoint& from, double factor) {
    const Vec3 away = from.eye - from.target;
    const Vec3 t = from.target;
    // Nearer, floats could not tell the eye from the target.
    const double least = std::max(
        1e-30, 1e-5 * static_cast<double>(std::max({std::abs(t.x), std::abs(t.y), std::abs(t.z)})));
    const double distance =
        std::clamp(static_cast<double>(length(away)) * factor, least, std::max(least, 1e30));
    Viewpoint moved = from;
    const Vec3 toward_eye = length(away) > 0 ? normalize(away) : Vec3{0, 0, 1};
    moved.eye = from.target + static_cast<float>(distance) * toward_eye;
    return moved;
}

Viewpoint level(const Viewpoint& from) {
    return {from.eye, from.target, {0, 1, 0}};
}

}  // namespace opaline::cli
