#include "bake/example/swan_field.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "bake/example/tapered_curve.h"

namespace opaline::bake {
namespace {

/// A feather of a fan: its spine runs in the plane x = 0 of the fan's own coordinates.
struct Feather {
    TaperedCurve spine;
    double lift;       ///< height above the fan's sheet [mm]
    double thickness;  ///< half of it at the root [mm]
};

struct Swan {
    TaperedCurve neck, beak;
    std::vector<Feather> flight, coverts, tail;
};

double mix(double a, double b, double t) {
    return a + (b - a) * t;
}

/// A blade around a spine: lens-shaped across with a rounded edge, so that neighbours in a fan meet
/// in a groove. `tilt` raises one side above the other, like shingles.
double blade(const Feather& feather, const glm::dvec3& p, double tilt) {
    constexpr double kEdge = 0.75;  ///< radius of the rounded rim [mm]
    const TaperedCurve::Nearest near = feather.spine.nearest({0.0, p.y, p.z});
    const double dy = p.y - near.point.y, dz = p.z - near.point.z;
    const double side = near.tangent.y * dz - near.tangent.z * dy;
    const double height = p.x - feather.lift - tilt * side;
    const double thickness = mix(feather.thickness, 0.55, near.fraction);
    const double wide = near.radius - kEdge;
    return ellipsoid({std::hypot(dy, dz), height, 0.0}, {wide, thickness, 1.0}) - kEdge;
}

/// Filleted union of the feathers of a fan that are near enough to matter at a surface point.
double fan(const std::vector<Feather>& feathers, const glm::dvec3& p, double tilt, double groove) {
    double d = 1e3;
    for (const Feather& feather : feathers) {
        const double bound = feather.spine.distance_bound(p) - 2.0;
        // Beyond the reach of the fillet, a far feather changes nothing.
        if (bound > 3.0 && d < 1e3) continue;
        const double f = bound > 3.0 ? bound : blade(feather, p, tilt);
        d = d < 1e3 ? smooth_union(d, f, groove) : f;
    }
    return d;
}

/// The wing's sheet bows out around the body and closes in toward the top and the tail: x as a
/// function of height and z, and the coordinates of a point relative to it.
glm::dvec3 wing_coordinates(const glm::dvec3& p) {
    const double up = (p.y - 52.0) / 40.0, back = (-8.0 - p.z) / 50.0;
    const double x = 27.0 - 9.0 * up * up + 3.0 * up - 9.0 * back * back - 2.0 * back;
    const double slope_y = (-18.0 * up + 3.0) / 40.0;
    const double slope_z = (18.0 * back + 2.0) / 50.0;
    return {(std::abs(p.x) - x) / std::sqrt(1.0 + slope_y * slope_y + slope_z * slope_z), p.y, p.z};
}

Feather make_feather(double lift, double thickness, glm::dvec2 root, glm::dvec2 tip, double bend,
                     double root_radius, double radius) {
    const glm::dvec2 along = tip - root;
    const glm::dvec2 across = bend * glm::dvec2(-along.y, along.x);
    const auto point = [&](double t, double r) {
        const glm::dvec2 q = root + t * along + 4.0 * t * (1.0 - t) * across;
        return glm::dvec4(0.0, q.y, q.x, r);
    };
    return {TaperedCurve({point(0.0, root_radius), point(0.35, mix(root_radius, radius, 0.8)),
                          point(0.7, 1.05 * radius), point(1.0, 0.62 * radius)}),
            lift, thickness};
}

std::vector<Feather> make_flight_feathers() {
    std::vector<Feather> feathers;
    constexpr int kCount = 8;
    for (int i = 0; i < kCount; ++i) {
        const double t = static_cast<double>(i) / (kCount - 1);
        const double angle = mix(0.30, 1.16, t);
        const double length = 46.0 + 17.0 * std::sin(3.14159265358979 * mix(0.22, 0.80, t));
        const glm::dvec2 root(mix(0.0, 15.0, t), mix(41.0, 50.0, t));
        const glm::dvec2 tip = root + length * glm::dvec2(-std::cos(angle), std::sin(angle));
        feathers.push_back(make_feather(-0.25 * i, 1.5, root, tip, -0.06, 4.5, 5.4));
    }
    return feathers;
}

std::vector<Feather> make_coverts() {
    std::vector<Feather> feathers;
    constexpr int kCount = 7;
    for (int i = 0; i < kCount; ++i) {
        const double t = static_cast<double>(i) / (kCount - 1);
        const double angle = mix(0.22, 1.22, t);
        const double length = 27.0 + 7.0 * std::sin(3.14159265358979 * mix(0.2, 0.85, t));
        const glm::dvec2 root(mix(2.0, 17.0, t), mix(39.0, 49.0, t));
        const glm::dvec2 tip = root + length * glm::dvec2(-std::cos(angle), std::sin(angle));
        feathers.push_back(make_feather(1.6 - 0.15 * i, 1.9, root, tip, -0.05, 5.0, 4.6));
    }
    return feathers;
}

/// The tail lies in a plane that rises to the back; its fan coordinates are (height, z, x).
std::vector<Feather> make_tail() {
    std::vector<Feather> feathers;
    for (int i = -2; i <= 2; ++i) {
        const double angle = 0.20 * i;
        const double length = 34.0 - 1.6 * i * i;
        const glm::dvec2 root(2.2 * i, 0.0);
        const glm::dvec2 tip = root + length * glm::dvec2(std::sin(angle), std::cos(angle));
        feathers.push_back(make_feather(-0.5 * std::abs(i), 1.7, root, tip, 0.0, 5.0, 4.2));
    }
    return feathers;
}

Swan make_parts() {
    return {TaperedCurve({{0.0, 34, 20, 15.5},
                          {0.0, 44, 35, 13.5},
                          {0.2, 58, 43, 9.6},
                          {0.8, 74, 38, 7.4},
                          {1.8, 90, 27, 6.4},
                          {3.2, 106, 23, 6.0},
                          {4.6, 117, 33, 6.6},
                          {6.2, 112, 43, 7.2},
                          {7.4, 107, 50, 5.4}}),
            TaperedCurve({{7.2, 108.5, 48, 5.0},
                          {8.2, 105, 55, 3.6},
                          {9.4, 101.5, 61, 2.7},
                          {10.2, 98.5, 66, 2.0}}),
            make_flight_feathers(), make_coverts(), make_tail()};
}

double body_distance(const glm::dvec3& p) {
    const glm::dvec3 q(p.x, p.y - 33.0, p.z + 4.0);
    double d = ellipsoid(q, {25.0, 21.5, 40.0});
    d = smooth_union(d, ellipsoid({p.x, p.y - 35.0, p.z - 17.0}, {20.0, 20.0, 21.0}), 12.0);
    // The rump rises toward the tail.
    return smooth_union(
        d,
        ellipsoid({p.x, p.y - 41.0 - 0.25 * (p.z + 40.0) * -1.0, p.z + 34.0}, {14.0, 11.0, 22.0}),
        14.0);
}

double wing_distance(const Swan& swan, const glm::dvec3& p) {
    const glm::dvec3 q = wing_coordinates(p);
    double d = fan(swan.flight, q, 0.10, 0.9);
    d = smooth_union(d, fan(swan.coverts, q, 0.10, 0.9), 1.2);
    const glm::dvec3 shoulder(q.x + 1.5, q.y - 45.0, q.z - 12.0);
    return smooth_union(d, ellipsoid(shoulder, {5.5, 11.0, 14.0}), 6.0);
}

double tail_distance(const Swan& swan, const glm::dvec3& p) {
    const double back = -p.z - 34.0;
    const double height = p.y - 42.0 - 0.32 * back + 0.012 * p.x * p.x;
    return fan(swan.tail, {height / std::sqrt(1.0 + 0.32 * 0.32), back, p.x}, 0.0, 0.9);
}

/// The pebble of water: a low disc whose top is rippled around the body.
double water_distance(const glm::dvec3& p, double body) {
    const double ripple =
        0.7 * std::cos(body * 0.80) * std::exp(-std::pow(std::max(body, 0.0) / 26.0, 2.0));
    const double rim = ellipsoid({p.x, 0.0, p.z + 2.0}, {41.0, 1e3, 55.0});
    const double top = p.y - 11.0 - ripple;
    return smooth_intersection(smooth_intersection(rim, top, 9.0), -p.y, 5.0);
}

double swan_distance(const Swan& swan, const glm::dvec3& p) {
    const double body = body_distance(p);
    double d = body;
    const auto join = [&](const TaperedCurve& tube, double width) {
        const double bound = tube.distance_bound(p);
        if (bound < d + width) {
            d = smooth_union(d, tube.distance(p), width);
        }
    };
    join(swan.neck, 10.0);
    const double head = ellipsoid({p.x - 5.6, p.y - 111.5, p.z - 42.5}, {6.6, 7.0, 8.6});
    d = smooth_union(d, head, 5.0);
    join(swan.beak, 2.0);
    d = smooth_union(d, wing_distance(swan, p), 4.0);
    d = smooth_union(d, tail_distance(swan, p), 5.0);
    return smooth_union(d, water_distance(p, body), 3.5);
}

}  // namespace

Solid make_swan() {
    auto swan = std::make_shared<const Swan>(make_parts());
    return {[swan = std::move(swan)](const glm::dvec3& p) { return swan_distance(*swan, p); },
            {{-48.0, -3.0, -76.0}, {48.0, 128.0, 76.0}}};
}

}  // namespace opaline::bake
