#include "bake/lab/example/scene_parts.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace opaline::bake {
namespace {

/// A feather of a fan: its spine runs in the plane x = 0 of the fan's own coordinates.
struct Feather {
    TaperedCurve spine;
    double lift;       ///< height above the fan's sheet [mm]
    double thickness;  ///< half of it at the root [mm]
};

constexpr double kGroove = 1.6;            ///< fillet between feathers [mm]
constexpr std::size_t kMostFeathers = 16;  ///< of one fan

struct Swan {
    TaperedCurve neck, bill;
    TaperedCurve arm;  ///< the wing's leading edge, in the wing's coordinates
    std::vector<Feather> flight, coverts, tail;
};

constexpr double kSwanSink = 0.4;  ///< depth of the flat foot below the floor [mm]

double mix(double a, double b, double t) {
    return a + (b - a) * t;
}

/// Distance to a tube, or a lower bound of it beyond the reach of every fillet.
double tube(const TaperedCurve& curve, const glm::dvec3& p) {
    const double bound = curve.distance_bound(p);
    return bound > 12.0 ? bound : curve.distance(p);
}

/// A blade around a spine: thick at the quill and thinner toward its rounded rim, so that
/// neighbours in a fan meet in a groove. `tilt` raises one side above the other, like shingles.
double blade(const Feather& feather, const glm::dvec3& p, double tilt) {
    constexpr double kWingRim = 1.0;  ///< radius of the rim [mm]
    const TaperedCurve::Nearest near = feather.spine.nearest({0.0, p.y, p.z});
    const double dy = p.y - near.point.y, dz = p.z - near.point.z;
    const double side = near.tangent.y * dz - near.tangent.z * dy;
    const double height = std::abs(p.x - feather.lift - tilt * side);
    const double wide = near.radius - kWingRim, reach = std::hypot(dy, dz);
    if (reach > wide) return std::hypot(reach - wide, height) - kWingRim;
    const double flat = 1.0 - reach * reach / (wide * wide);
    return height - mix(feather.thickness, 0.2, near.fraction) * flat * flat - kWingRim;
}

/// Filleted union of the feathers of a fan; of those too far to matter only a bound is taken.
double fan(const std::vector<Feather>& feathers, const glm::dvec3& p, double tilt, double groove) {
    constexpr double kFar = 7.0;     // beyond the reach of the fillets between fan and body
    constexpr double kMargin = 1.0;  // a blade is only roughly a distance
    std::array<double, kMostFeathers> bound{};
    assert(feathers.size() <= bound.size());
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < feathers.size(); ++i) {
        bound[i] = feathers[i].spine.distance_bound(p) - kMargin;
        if (bound[i] < bound[nearest]) nearest = i;
    }
    if (bound[nearest] > kFar) return bound[nearest];
    // Unions run in one order everywhere: fillets of three feathers depend on it a little.
    const double first = blade(feathers[nearest], p, tilt);
    double d = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < feathers.size(); ++i) {
        if (bound[i] > first + 2.0 * groove) continue;
        d = smooth_union(d, i == nearest ? first : blade(feathers[i], p, tilt), groove);
    }
    return d;
}

/// The wing's sheet bows out around the body and closes in toward the top and the tail: x as a
/// function of height and z, and the coordinates of a point relative to it.
glm::dvec3 wing_coordinates(const glm::dvec3& p) {
    const double up = (p.y - 52.0) / 40.0, back = (-8.0 - p.z) / 50.0;
    const double x = 25.5 - 11.0 * up * up + 6.0 * up - 9.0 * back * back - 2.0 * back;
    const double slope_y = (-22.0 * up + 6.0) / 40.0;
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

/// A fan of `count` feathers; shape(t) gives the feather at t in [0, 1] across the fan. Between
/// each two lies a shorter one, so that every notch ends in a round web and the fan has no slits.
template <class Shape>
std::vector<Feather> make_fan(int count, const Shape& shape) {
    std::vector<Feather> feathers;
    for (int i = 0; i < 2 * count - 1; ++i) {
        feathers.push_back(shape(static_cast<double>(i) / (2 * count - 2), i % 2 != 0));
    }
    return feathers;
}

std::vector<Feather> make_flight_feathers() {
    return make_fan(8, [](double t, bool between) {
        const double angle = mix(0.26, 1.22, t);
        const double length = 46.0 + 17.0 * std::sin(std::numbers::pi * mix(0.22, 0.80, t));
        const glm::dvec2 root(mix(0.0, 15.0, t), mix(41.0, 50.0, t));
        const glm::dvec2 tip =
            root + (between ? 0.87 : 1.0) * length * glm::dvec2(-std::cos(angle), std::sin(angle));
        return make_feather(-1.75 * t, between ? 1.0 : 1.5, root, tip, mix(-0.07, -0.14, t), 4.5,
                            between ? 4.6 : 5.4);
    });
}

std::vector<Feather> make_coverts() {
    return make_fan(6, [](double t, bool between) {
        const double angle = mix(0.22, 1.20, t);
        const double length = 28.0 + 7.0 * std::sin(std::numbers::pi * mix(0.2, 0.85, t));
        const glm::dvec2 root(mix(2.0, 16.0, t), mix(39.0, 49.0, t));
        const glm::dvec2 tip =
            root + (between ? 0.82 : 1.0) * length * glm::dvec2(-std::cos(angle), std::sin(angle));
        return make_feather(mix(1.6, 0.6, t), between ? 1.1 : 1.9, root, tip, mix(-0.07, -0.12, t),
                            5.0, between ? 4.0 : 4.7);
    });
}

/// The tail lies in a plane that rises to the back; its fan coordinates are (height, z, x).
std::vector<Feather> make_tail() {
    return make_fan(5, [](double t, bool between) {
        const double across = 4.0 * t - 2.0;
        const double angle = 0.20 * across;
        const double length = (between ? 0.84 : 1.0) * (34.0 - 1.6 * across * across);
        const glm::dvec2 root(2.2 * across, 0.0);
        const glm::dvec2 tip = root + length * glm::dvec2(std::sin(angle), std::cos(angle));
        return make_feather(-0.3 * across * across, between ? 1.1 : 1.7, root, tip, 0.0, 5.0,
                            between ? 3.6 : 4.2);
    });
}

Swan make_parts() {
    return {TaperedCurve({{0.0, 34, 20, 15.5},
                          {0.0, 44, 35, 13.5},
                          {0.2, 58, 43, 9.6},
                          {0.8, 74, 39, 7.3},
                          {1.8, 91, 28, 6.2},
                          {3.2, 109, 23, 5.7},
                          {4.6, 121, 33, 5.7},
                          {5.6, 117, 42, 5.0}}),
            TaperedCurve({{0.0, -0.4, 5.0, 4.6},
                          {0.0, -1.0, 11.0, 3.5},
                          {0.0, -1.9, 17.0, 2.7},
                          {0.0, -2.4, 22.5, 2.5}}),
            TaperedCurve({{0.0, 42, 12, 6.0},
                          {0.0, 52, 21, 4.8},
                          {0.0, 64, 21, 3.6},
                          {0.0, 76, 16, 2.6},
                          {0.0, 88, 9, 1.0}}),
            make_flight_feathers(),
            make_coverts(),
            make_tail()};
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
    // Nothing of the wing is farther than 7 mm from its sheet.
    if (std::abs(q.x) > 14.0) return std::abs(q.x) - 7.0;
    double d = fan(swan.flight, q, 0.10, kGroove);
    d = smooth_union(d, fan(swan.coverts, q, 0.10, kGroove), 1.2);
    d = smooth_union(d, tube(swan.arm, q), 3.0);
    const glm::dvec3 shoulder(q.x + 1.5, q.y - 45.0, q.z - 12.0);
    return smooth_union(d, ellipsoid(shoulder, {5.5, 11.0, 14.0}), 6.0);
}

double tail_distance(const Swan& swan, const glm::dvec3& p) {
    const double back = -p.z - 34.0;
    const double height = p.y - 42.0 - 0.32 * back + 0.012 * p.x * p.x;
    const glm::dvec3 q(height / std::sqrt(1.0 + 0.32 * 0.32), back, p.x);
    if (std::abs(q.x) > 12.0) return std::abs(q.x) - 5.0;
    return fan(swan.tail, q, 0.0, kGroove);
}

/// Head and bill in the head's own frame: x to its left, y to its crown, z along the bill.
double head_distance(const Swan& swan, const glm::dvec3& p) {
    const glm::dvec3 center(5.0, 115.6, 40.5);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(0.20, -0.46, 0.86));
    const glm::dvec3 left = glm::normalize(glm::cross({0.0, 1.0, 0.0}, forward));
    const glm::dvec3 crown = glm::cross(forward, left);
    const glm::dvec3 q(std::abs(glm::dot(p - center, left)), glm::dot(p - center, crown),
                       glm::dot(p - center, forward));
    double d = ellipsoid(q, {5.9, 6.3, 8.8});
    if (d > 30.0) return d - 20.0;
    // The bill is wider than it is high.
    const double squash = 1.3;
    const double bill = tube(swan.bill, {q.x, squash * q.y, q.z}) / std::sqrt(squash);
    d = smooth_union(d, bill, 1.6);
    const double knob = ellipsoid(q - glm::dvec3(0.0, 2.2, 8.2), {1.7, 1.6, 3.0});
    d = smooth_union(d, knob, 2.0);
    const double eye = glm::distance(q, {4.75, 1.5, 4.0}) - 1.1;
    return smooth_union(d, eye, 0.7);
}

/// The pebble of water: a low disc whose top is rippled around the body.
double water_distance(const glm::dvec3& p, double body) {
    const double ripple =
        0.7 * std::cos(body * 0.80) * std::exp(-std::pow(std::max(body, 0.0) / 26.0, 2.0));
    const double rim = ellipsoid({p.x, 0.0, p.z + 2.0}, {41.0, 1e3, 55.0});
    const double top = p.y - 9.5 - ripple;
    return smooth_intersection(smooth_intersection(rim, top, 9.0), -kSwanSink - p.y, 5.0);
}

double swan_distance(const Swan& swan, const glm::dvec3& p) {
    // The bird was drawn on land; it swims a little deeper.
    const glm::dvec3 q(p.x, p.y + 7.0, p.z);
    const double body = body_distance(q);
    double d = body;
    d = smooth_union(d, tube(swan.neck, q), 10.0);
    d = smooth_union(d, head_distance(swan, q), 4.0);
    d = smooth_union(d, wing_distance(swan, q), 4.0);
    d = smooth_union(d, tail_distance(swan, q), 5.0);
    return smooth_union(d, water_distance(p, body), 3.0);
}

}  // namespace

Solid make_swan() {
    auto swan = std::make_shared<const Swan>(make_parts());
    return {[swan = std::move(swan)](const glm::dvec3& p) { return swan_distance(*swan, p); },
            {{-48.0, -3.0, -76.0}, {48.0, 128.0, 76.0}}};
}

}  // namespace opaline::bake
