#include "runtime/picture/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "runtime/picture/frame_layer.h"
#include "runtime/volumes/volume_bounds.h"

namespace opaline::runtime {
namespace {

using formats::AssetView;
using formats::PrimitiveRecord;
using formats::Vec3;

// Double precision: squares of coordinates near the float limit still fit.
struct Double3 {
    double x = 0, y = 0, z = 0;
};

Double3 widen(Vec3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Double3 minus(Double3 a, Double3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Double3 cross_product(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double norm(Double3 v) {
    return std::hypot(v.x, v.y, v.z);
}
bool is_finite(Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// A float that stays finite when a few of its kind are added up.
float narrow(double value) {
    return static_cast<float>(std::clamp(value, -3e37, 3e37));
}

struct Box {
    Double3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    bool is_empty() const { return low.x > high.x; }
    Double3 size() const { return is_empty() ? Double3{} : minus(high, low); }
};

void extend(Box& box, Double3 p) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
}

std::span<const Vec3> positions_of(const AssetView& asset, const PrimitiveRecord& primitive) {
    return asset.position.subspan(primitive.first_vertex, primitive.vertex_count);
}

Box box_of(std::span<const Vec3> positions) {
    Box box;
    for (const Vec3 p : positions) {
        if (is_finite(p)) extend(box, widen(p));
    }
    return box;
}

// Length of the summed area vectors over the summed areas: 1 for a plane, 0 for a closed surface.
double sheet_coherence(const AssetView& asset, const PrimitiveRecord& primitive) {
    const auto positions = positions_of(asset, primitive);
    const auto indices = asset.index.subspan(primitive.first_index, primitive.index_count);
    Double3 sum;
    double area = 0;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const Vec3 a = positions[indices[i]], b = positions[indices[i + 1]],
                   c = positions[indices[i + 2]];
        if (!is_finite(a) || !is_finite(b) || !is_finite(c)) continue;
        const Double3 n = cross_product(minus(widen(b), widen(a)), minus(widen(c), widen(a)));
        sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
        area += norm(n);
    }
    return area > 0 ? norm(sum) / area : 0;
}

bool is_flat(const AssetView& asset, const PrimitiveRecord& primitive, const Box& box) {
    const Double3 size = box.size();
    const double thickness = std::min({size.x, size.y, size.z});
    return thickness < 0.05 * norm(size) || sheet_coherence(asset, primitive) > 0.98;
}

// Around these primitives and all volumes.
Box box_of_parts(const AssetView& asset, std::span<const std::size_t> chosen) {
    Box all = box_of(volume_corners(asset.volumes));
    for (const std::size_t p : chosen) {
        const Box box = box_of(positions_of(asset, asset.primitives[p]));
        if (!box.is_empty()) {
            extend(all, box.low);
            extend(all, box.high);
        }
    }
    return all;
}

// Calls see(point) with all of their points.
template <class See>
void for_each_point(const AssetView& asset, std::span<const std::size_t> chosen, See&& see) {
    const auto visit = [&](std::span<const Vec3> positions) {
        for (const Vec3 v : positions) {
            if (is_finite(v)) see(widen(v));
        }
    };
    visit(volume_corners(asset.volumes));
    for (const std::size_t p : chosen) {
        visit(positions_of(asset, asset.primitives[p]));
    }
}

Double3 middle_of(const Box& box) {
    return {0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y),
            0.5 * (box.low.z + box.high.z)};
}

BoundingSphere bound_parts(const AssetView& asset, std::span<const std::size_t> chosen) {
    const Box all = box_of_parts(asset, chosen);
    if (all.is_empty()) return {};
    const Double3 centre = middle_of(all);
    double radius = 0;
    for_each_point(asset, chosen,
                   [&](Double3 p) { radius = std::max(radius, norm(minus(p, centre))); });
    return {centre.x, centre.y, centre.z, radius};
}

std::vector<std::size_t> all_primitives(const AssetView& asset) {
    std::vector<std::size_t> all(asset.primitives.size());
    for (std::size_t p = 0; p < all.size(); ++p) {
        all[p] = p;
    }
    return all;
}

// A radius to work with: never 0, and not below what floats can tell apart at that distance from
// the origin.
double usable_radius(const BoundingSphere& sphere) {
    const double away = std::max({std::abs(sphere.x), std::abs(sphere.y), std::abs(sphere.z)});
    const double least = std::max(1e-6 * away, 1e-30);
    return sphere.radius > 0 ? std::max(sphere.radius, least) : std::max(1e-2 * away, 1.0);
}

}  // namespace

CameraFrame camera_frame(const Camera& camera) {
    CameraFrame frame;
    Double3 back = minus(widen(camera.eye), widen(camera.target));
    const double distance = norm(back);
    back = distance > 0 ? Double3{back.x / distance, back.y / distance, back.z / distance}
                        : Double3{0, 0, 1};
    Double3 up = widen(camera.up);
    const double up_length = norm(up);
    if (up_length > 0) up = {up.x / up_length, up.y / up_length, up.z / up_length};
    Double3 right = cross_product(up, back);
    // `up` along the view says nothing: then -Z is up on the image, as on a map.
    if (norm(right) < 1e-6) {
        right = cross_product(std::abs(back.y) > 0.5 ? Double3{0, 0, -1} : Double3{0, 1, 0}, back);
    }
    const double right_length = norm(right);
    right = {right.x / right_length, right.y / right_length, right.z / right_length};
    up = cross_product(back, right);
    frame.right = {narrow(right.x), narrow(right.y), narrow(right.z)};
    frame.up = {narrow(up.x), narrow(up.y), narrow(up.z)};
    frame.backward = {narrow(back.x), narrow(back.y), narrow(back.z)};
    frame.tan_half_y = std::tan(static_cast<double>(camera.fov_y) * std::numbers::pi / 360.0);
    frame.tan_half_x = frame.tan_half_y * camera.width / std::max(camera.height, 1u);
    return frame;
}

Vec3 view_ray(const Camera& camera, const CameraFrame& frame, double x, double y) {
    const auto s = static_cast<float>((2.0 * x / camera.width - 1.0) * frame.tan_half_x);
    const auto t = static_cast<float>((1.0 - 2.0 * y / camera.height) * frame.tan_half_y);
    return normalize(s * frame.right + t * frame.up - frame.backward);
}

BoundingSphere bound_asset(const AssetView& asset) {
    return bound_parts(asset, all_primitives(asset));
}

namespace {

// Thin for its width, and level.
bool is_level(const Box& box) {
    const Double3 size = box.size();
    return size.y < 0.05 * std::hypot(size.x, size.z);
}

// Those that are no part of a level ground: the widest level part and what is level with it.
std::vector<std::size_t> parts_above_ground(const AssetView& asset,
                                            std::span<const std::size_t> parts) {
    Box ground;
    for (const std::size_t p : parts) {
        const Box box = box_of(positions_of(asset, asset.primitives[p]));
        if (is_level(box) && norm(box.size()) > norm(ground.size())) ground = box;
    }
    const double top = ground.high.y + 2e-3 * norm(ground.size());
    std::vector<std::size_t> above;
    for (const std::size_t p : parts) {
        const Box box = box_of(positions_of(asset, asset.primitives[p]));
        if (!is_level(box) || !(box.high.y <= top)) above.push_back(p);
    }
    const Box rest = box_of_parts(asset, above);
    const bool is_below =
        !rest.is_empty() && ground.low.y <= rest.low.y + 0.1 * (rest.high.y - rest.low.y);
    return is_below ? above : std::vector<std::size_t>(parts.begin(), parts.end());
}

std::vector<std::size_t> object_parts(const AssetView& asset) {
    std::vector<std::size_t> chosen;
    std::size_t largest = 0;
    double largest_size = -1;
    for (const std::size_t p : all_primitives(asset)) {
        const Box box = box_of(positions_of(asset, asset.primitives[p]));
        if (box.is_empty()) continue;
        chosen.push_back(p);
        if (norm(box.size()) > largest_size) {
            largest_size = norm(box.size());
            largest = p;
        }
    }
    if (chosen.size() + asset.volumes.records.size() < 2 || chosen.empty()) return chosen;
    constexpr double kShrinksIt = 1.3, kDwarfs = 3;
    const double radius = bound_parts(asset, chosen).radius;
    std::vector<std::size_t> above = parts_above_ground(asset, chosen);
    if (radius >= kShrinksIt * bound_parts(asset, above).radius) return above;
    const PrimitiveRecord& primitive = asset.primitives[largest];
    if (!is_flat(asset, primitive, box_of(positions_of(asset, primitive)))) return chosen;
    std::vector<std::size_t> rest = chosen;
    std::erase(rest, largest);
    return radius >= kDwarfs * bound_parts(asset, rest).radius ? rest : chosen;
}

// Least distance from its middle at which both rims of the cylinder lie in the frame: a point at x,
// y, z in the camera's frame does where |x| and |y| are below (distance - z) times the tangents.
double distance_of(const UprightBounds& upright, double elevation, const CameraFrame& frame) {
    constexpr int kPoints = 64;
    const double c = std::cos(elevation), s = std::sin(elevation);
    double least = 0;
    for (int i = 0; i < kPoints; ++i) {
        const double a = 2 * std::numbers::pi * i / kPoints;
        const double x = upright.radius * std::sin(a), toward = upright.radius * std::cos(a);
        for (const double h : {upright.half_height, -upright.half_height}) {
            const double y = h * c - toward * s, z = h * s + toward * c;
            least = std::max(
                {least, z + std::abs(x) / frame.tan_half_x, z + std::abs(y) / frame.tan_half_y});
        }
    }
    return least;
}

}  // namespace

BoundingSphere bound_object(const AssetView& asset) {
    return bound_parts(asset, object_parts(asset));
}

UprightBounds bound_upright(const AssetView& asset) {
    const std::vector<std::size_t> parts = object_parts(asset);
    const Box box = box_of_parts(asset, parts);
    if (box.is_empty()) return {};
    const Double3 centre = middle_of(box);
    UprightBounds upright{0, 0.5 * (box.high.y - box.low.y)};
    for_each_point(asset, parts, [&](Double3 p) {
        upright.radius = std::max(upright.radius, std::hypot(p.x - centre.x, p.z - centre.z));
    });
    return upright;
}

Vec3 view_direction(double azimuth, double elevation) {
    const double a = azimuth * std::numbers::pi / 180.0, e = elevation * std::numbers::pi / 180.0;
    return {narrow(std::sin(a) * std::cos(e)), narrow(std::sin(e)),
            narrow(std::cos(a) * std::cos(e))};
}

double front_share(const AssetView& asset, Vec3 direction) {
    const Double3 d = widen(direction);
    double front = 0, back = 0;
    for (const PrimitiveRecord& primitive : asset.primitives) {
        const bool is_double_sided = (primitive.flags & PrimitiveRecord::kDoubleSided) != 0;
        const auto positions = positions_of(asset, primitive);
        const auto indices = asset.index.subspan(primitive.first_index, primitive.index_count);
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            const Double3 a = widen(positions[indices[i]]);
            const Double3 n = cross_product(minus(widen(positions[indices[i + 1]]), a),
                                            minus(widen(positions[indices[i + 2]]), a));
            const double facing = n.x * d.x + n.y * d.y + n.z * d.z;
            if (!std::isfinite(facing)) continue;
            (facing > 0 || is_double_sided ? front : back) += std::abs(facing);
        }
    }
    return front + back > 0 && std::isfinite(front + back) ? front / (front + back) : 1;
}

namespace {

// Closed surfaces show as much front as back: half. Less than a quarter are backs of sheets.
Vec3 choose_direction(const AssetView& asset) {
    constexpr double kAzimuth = 30, kLeastFront = 0.25;
    // Low enough for a horizon in the upper part of the picture; flat things are seen from above.
    constexpr double kUpright = 10, kFlat = 22;
    const UprightBounds upright = bound_upright(asset);
    const double height =
        upright.radius > 0 ? std::min(1.0, 2 * upright.half_height / upright.radius) : 1;
    const double elevation = kFlat + (kUpright - kFlat) * height;
    Vec3 best = view_direction(kAzimuth, elevation);
    double most = front_share(asset, best);
    for (int turn = 1; turn < 4 && most < kLeastFront; ++turn) {
        const Vec3 direction = view_direction(kAzimuth + 90 * turn, elevation);
        const double share = front_share(asset, direction);
        if (share > most) {
            most = share;
            best = direction;
        }
    }
    return best;
}

}  // namespace

float near_plane_for(const AssetView& asset, Vec3 eye) {
    const BoundingSphere sphere = bound_asset(asset);
    const double radius = usable_radius(sphere);
    if (!asset.clouds.empty()) {
        return sphere.radius > 0 ? std::min(kLayerNearPlane, narrow(1e-3 * radius))
                                 : kLayerNearPlane;
    }
    const double distance = norm(minus(widen(eye), {sphere.x, sphere.y, sphere.z}));
    return narrow(std::max(0.5 * (distance - radius), 1e-3 * radius));
}

Camera frame_from(const AssetView& asset, Vec3 direction, float fov_y, std::uint32_t width,
                  std::uint32_t height) {
    Camera camera;
    camera.fov_y = fov_y;
    camera.width = width;
    camera.height = height;
    const BoundingSphere sphere = bound_object(asset);
    const CameraFrame frame = camera_frame(camera);
    const double half = std::atan(std::min(frame.tan_half_x, frame.tan_half_y));
    const Double3 d = widen(direction);
    constexpr double kMargin = 1.04;
    const double radius = usable_radius(sphere);
    // The object lies within both bounds.
    double distance = radius / std::max(std::sin(half), 1e-3);
    if (sphere.radius > 0) {
        const double elevation = std::atan2(d.y, std::hypot(d.x, d.z));
        const double upright = distance_of(bound_upright(asset), elevation, frame);
        distance = std::clamp(upright, radius, distance);
    }
    distance *= kMargin;
    camera.target = {narrow(sphere.x), narrow(sphere.y), narrow(sphere.z)};
    camera.eye = {narrow(sphere.x + distance * d.x), narrow(sphere.y + distance * d.y),
                  narrow(sphere.z + distance * d.z)};
    camera.near_plane = near_plane_for(asset, camera.eye);
    return camera;
}

Camera frame_asset(const AssetView& asset, float fov_y, std::uint32_t width, std::uint32_t height) {
    if (!asset.clouds.empty() && asset.primitives.empty() && asset.volumes.empty()) {
        return frame_layer(asset.clouds.records.front(), fov_y, width, height);
    }
    return frame_from(asset, choose_direction(asset), fov_y, width, height);
}

Camera orbit(const Camera& camera, float degrees) {
    const double radians = static_cast<double>(degrees) * std::numbers::pi / 180.0;
    const double c = std::cos(radians), s = std::sin(radians);
    const auto turn = [&](Double3 v) { return Double3{c * v.x + s * v.z, v.y, c * v.z - s * v.x}; };
    const Double3 target = widen(camera.target);
    const Double3 eye = turn(minus(widen(camera.eye), target));
    const Double3 up = turn(widen(camera.up));
    Camera turned = camera;
    turned.eye = {narrow(target.x + eye.x), narrow(target.y + eye.y), narrow(target.z + eye.z)};
    turned.up = {narrow(up.x), narrow(up.y), narrow(up.z)};
    return turned;
}

}  // namespace opaline::runtime
