#include "formats/opal/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/opal/cubemap.h"

namespace opaline::formats {
namespace {

Rgb mix(Rgb a, Rgb b, float t) {
    return (1.0f - t) * a + t * b;
}

Rgb sample_lat_long(const Environment& env, Vec3 d) {
    const auto width = static_cast<std::int64_t>(env.width);
    const auto height = static_cast<std::int64_t>(env.height);
    const float turn = std::atan2(d.z, d.x) * (0.5f * std::numbers::inv_pi_v<float>);
    const float u = env.u_offset + env.u_sign * turn;
    const float v = std::acos(std::clamp(d.y, -1.0f, 1.0f)) * std::numbers::inv_pi_v<float>;
    const float x = (u - std::floor(u)) * static_cast<float>(env.width) - 0.5f;
    const float y = env.rows_include_poles ? v * static_cast<float>(env.height - 1)
                                           : v * static_cast<float>(env.height) - 0.5f;
    const float x_floor = std::floor(x), y_floor = std::floor(y);
    const auto column = static_cast<std::int64_t>(x_floor),
               row = static_cast<std::int64_t>(y_floor);
    const auto at = [&](std::int64_t i, std::int64_t j) {
        i = (i % width + width) % width;
        j = std::clamp<std::int64_t>(j, 0, height - 1);
        return env.pixel[static_cast<std::size_t>(j * width + i)];
    };
    return mix(mix(at(column, row), at(column + 1, row), x - x_floor),
               mix(at(column, row + 1), at(column + 1, row + 1), x - x_floor), y - y_floor);
}

Rgb sample_cube(const Environment& env, Vec3 d) {
    const std::uint32_t n = env.width;
    const float size = static_cast<float>(n);
    const CubePoint p = cube_point(d);
    const float x = (p.u * 0.5f + 0.5f) * size - 0.5f, y = (p.v * 0.5f + 0.5f) * size - 0.5f;
    const float x_floor = std::floor(x), y_floor = std::floor(y);
    const auto at = [&](float column, float row) {
        if (column < 0 || row < 0 || column > size - 1 || row > size - 1) {
            // Over the edge: the texel of the neighbouring face that this direction falls into.
            const Vec3 beyond = cube_position(
                {p.face, 2.0f * (column + 0.5f) / size - 1.0f, 2.0f * (row + 0.5f) / size - 1.0f});
            return env.pixel[texel_index(n, beyond)];
        }
        return env.pixel[(std::size_t{p.face} * n + static_cast<std::size_t>(row)) * n +
                         static_cast<std::size_t>(column)];
    };
    return mix(mix(at(x_floor, y_floor), at(x_floor + 1, y_floor), x - x_floor),
               mix(at(x_floor, y_floor + 1), at(x_floor + 1, y_floor + 1), x - x_floor),
               y - y_floor);
}

}  // namespace

double disc_solid_angle(float angular_radius) {
    const double s = std::sin(0.5 * static_cast<double>(angular_radius));
    return 4.0 * std::numbers::pi * s * s;
}

Rgb sample_map(const Environment& environment, Vec3 direction) {
    if (environment.pixel.empty()) {
        return {};
    }
    return environment.layout == Environment::Layout::cube
               ? sample_cube(environment, direction)
               : sample_lat_long(environment, direction);
}

Rgb sample_radiance(const Environment& environment, Vec3 direction) {
    Rgb radiance = sample_map(environment, direction);
    for (const DistantDisc& disc : environment.discs) {
        // The chord, not the cosine: the sun's cosine differs from one by 1e-5 only.
        const float chord = length(direction - disc.direction);
        if (chord <= 2.0f * std::sin(0.5f * disc.angular_radius)) {
            radiance = radiance + disc.radiance;
        }
    }
    return radiance;
}

}  // namespace opaline::formats
