#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/lights/builtin_environment.h"

namespace opaline::bake {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

constexpr std::uint32_t kStudioWidth = 1024, kStudioHeight = 512;

float smooth(float from, float to, float value) {
    const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

/// A bright rectangle with rounded corners, seen from the origin.
struct SoftBox {
    Vec3 center, right, up;         ///< unit, orthogonal
    float half_width, half_height;  ///< in the plane at distance 1
    float softness;                 ///< width of the fading border, same unit
    Rgb radiance;                   ///< in the middle; the corners are a third darker
};

SoftBox make_soft_box(double azimuth, double elevation, double width, double height, float softness,
                      Rgb radiance) {
    const auto half = [](double degrees) {
        return static_cast<float>(std::tan(0.5 * degrees * std::numbers::pi / 180));
    };
    const Vec3 center = direction_of(azimuth, elevation);
    const Vec3 right = direction_of(azimuth + 90, 0);
    return {center, right, cross(center, right), half(width), half(height), softness, radiance};
}

Rgb eval_soft_box(const SoftBox& box, Vec3 d) {
    const float depth = dot(d, box.center);
    if (depth <= 0.05f) return {};
    const float x = std::abs(dot(d, box.right)) / depth, y = std::abs(dot(d, box.up)) / depth;
    const float corner = 0.35f * std::min(box.half_width, box.half_height);
    const float dx = x - box.half_width + corner, dy = y - box.half_height + corner;
    const float distance = std::hypot(std::max(dx, 0.0f), std::max(dy, 0.0f)) +
                           std::min(std::max(dx, dy), 0.0f) - corner;
    const float inside = 1 - smooth(-box.softness, box.softness, distance);
    const float u = x / box.half_width, v = y / box.half_height;
    const float bulb = 1 / (1 + 0.25f * (u * u + v * v));
    return (inside * bulb) * box.radiance;
}

Rgb eval_room(Vec3 d) {
    const Rgb wall{0.120f, 0.124f, 0.132f}, ceiling{0.045f, 0.048f, 0.055f};
    const Rgb floor_far{0.070f, 0.066f, 0.062f}, floor_near{0.030f, 0.028f, 0.026f};
    const float rise = smooth(0.0f, 0.9f, d.y), fall = smooth(0.0f, 0.8f, -d.y);
    const Rgb above = (1 - rise) * wall + rise * ceiling;
    const Rgb below = (1 - fall) * floor_far + fall * floor_near;
    const float horizon = smooth(-0.16f, 0.10f, d.y);  // a curved backdrop has no edge
    Rgb color = (1 - horizon) * below + horizon * above;
    // A lamp on the wall behind the object separates its dark outline from the backdrop.
    const Vec3 behind = direction_of(180, 6);
    const float glow = std::exp(-5.0f * (1 - dot(d, behind)));
    return color + (0.30f * glow * (0.35f + 0.65f * horizon)) * Rgb{0.92f, 0.97f, 1.06f};
}

}  // namespace

Environment make_studio() {
    const Rgb warm{1.08f, 0.99f, 0.86f}, neutral{1.0f, 1.0f, 1.0f}, cool{0.84f, 0.98f, 1.20f};
    const SoftBox boxes[] = {
        make_soft_box(-44, 40, 44, 36, 0.10f, 7.0f * warm),     // key
        make_soft_box(64, 10, 46, 56, 0.20f, 0.6f * neutral),   // fill
        make_soft_box(146, 16, 10, 54, 0.06f, 8.5f * cool),     // rim, right
        make_soft_box(-140, 24, 8, 50, 0.06f, 9.5f * cool),     // rim, left
        make_soft_box(180, 78, 44, 20, 0.12f, 1.4f * neutral),  // overhead
    };
    Environment environment;
    environment.width = kStudioWidth;
    environment.height = kStudioHeight;
    environment.pixel.reserve(std::size_t{kStudioWidth} * kStudioHeight);
    for (std::uint32_t row = 0; row < kStudioHeight; ++row) {
        const float theta =
            std::numbers::pi_v<float> * (static_cast<float>(row) + 0.5f) / kStudioHeight;
        for (std::uint32_t column = 0; column < kStudioWidth; ++column) {
            const float phi = std::numbers::pi_v<float> *
                              (2 * (static_cast<float>(column) + 0.5f) / kStudioWidth - 1);
            const Vec3 d{std::sin(theta) * std::cos(phi), std::cos(theta),
                         std::sin(theta) * std::sin(phi)};
            Rgb radiance = eval_room(d);
            for (const SoftBox& box : boxes) {
                radiance = radiance + eval_soft_box(box, d);
            }
            environment.pixel.push_back(radiance);
        }
    }
    return environment;
}

}  // namespace opaline::bake
