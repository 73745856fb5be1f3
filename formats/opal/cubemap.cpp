#include "formats/opal/cubemap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opaline::formats {

Vec3 cube_position(CubePoint p) {
    switch (p.face) {
        case 0:
            return {1, -p.v, -p.u};
        case 1:
            return {-1, -p.v, p.u};
        case 2:
            return {p.u, 1, p.v};
        case 3:
            return {p.u, -1, -p.v};
        case 4:
            return {p.u, -p.v, 1};
        default:
            return {-p.u, -p.v, -1};
    }
}

CubePoint cube_point(Vec3 d) {
    const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
    if (ax >= ay && ax >= az) {
        return d.x > 0 ? CubePoint{0, -d.z / ax, -d.y / ax} : CubePoint{1, d.z / ax, -d.y / ax};
    }
    if (ay >= az) {
        return d.y > 0 ? CubePoint{2, d.x / ay, d.z / ay} : CubePoint{3, d.x / ay, -d.z / ay};
    }
    return d.z > 0 ? CubePoint{4, d.x / az, -d.y / az} : CubePoint{5, -d.x / az, -d.y / az};
}

Vec3 texel_direction(std::uint32_t n, std::uint32_t face, std::uint32_t row, std::uint32_t column) {
    const float step = 2.0f / static_cast<float>(n);
    return normalize(cube_position({face, (static_cast<float>(column) + 0.5f) * step - 1.0f,
                                    (static_cast<float>(row) + 0.5f) * step - 1.0f}));
}

std::uint32_t texel_index(std::uint32_t n, Vec3 direction) {
    const CubePoint p = cube_point(direction);
    const auto texel = [n](float x) {
        const float scaled = (x * 0.5f + 0.5f) * static_cast<float>(n);
        return std::min(static_cast<std::uint32_t>(std::max(scaled, 0.0f)), n - 1);
    };
    return (p.face * n + texel(p.v)) * n + texel(p.u);
}

double rectangle_solid_angle(double u0, double v0, double u1, double v1) {
    const auto corner = [](double u, double v) {
        return std::atan2(u * v, std::sqrt(u * u + v * v + 1.0));
    };
    return corner(u1, v1) - corner(u0, v1) - corner(u1, v0) + corner(u0, v0);
}

std::vector<double> texel_solid_angles(std::uint32_t n) {
    std::vector<double> solid_angle(std::size_t{n} * n);
    const double step = 2.0 / n;
    for (std::uint32_t row = 0; row < n; ++row) {
        for (std::uint32_t column = 0; column < n; ++column) {
            const double u = column * step - 1.0, v = row * step - 1.0;
            solid_angle[std::size_t{row} * n + column] =
                rectangle_solid_angle(u, v, u + step, v + step);
        }
    }
    return solid_angle;
}

namespace {

using Double3 = std::array<double, 3>;

// Angle between two unit-cube points and the unit normal of their plane, combined: the edge's
// contribution to Lambert's polygon formula.
Double3 edge_moment(const Double3& a, const Double3& b) {
    const Double3 normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    const double sine = std::hypot(normal[0], normal[1], normal[2]);
    const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double weight = 0.5 * std::atan2(sine, cosine) / sine;
    return {weight * normal[0], weight * normal[1], weight * normal[2]};
}

}  // namespace

std::vector<Vec3> texel_moments(std::uint32_t n) {
    std::vector<Vec3> moment(cubemap_texels(n));
    const double step = 2.0 / n;
    // Face +Z is worked out in double precision, the others are its exact permutations.
    for (std::uint32_t row = 0; row < n; ++row) {
        for (std::uint32_t column = 0; column < n; ++column) {
            const double u0 = column * step - 1.0, v0 = row * step - 1.0;
            const double u1 = u0 + step, v1 = v0 + step;
            const std::array<Double3, 4> corner{
                {{u0, -v0, 1.0}, {u0, -v1, 1.0}, {u1, -v1, 1.0}, {u1, -v0, 1.0}}};
            Double3 sum{};
            for (std::size_t i = 0; i < 4; ++i) {
                const Double3 edge = edge_moment(corner[i], corner[(i + 1) % 4]);
                for (std::size_t k = 0; k < 3; ++k) {
                    sum[k] += edge[k];
                }
            }
            // In face coordinates: along +u, along +v, outward.
            const float along_u = static_cast<float>(sum[0]);
            const float along_v = static_cast<float>(-sum[1]);
            const float outward = static_cast<float>(sum[2]);
            const std::array<Vec3, 6> by_face{{{outward, -along_v, -along_u},
                                               {-outward, -along_v, along_u},
                                               {along_u, outward, along_v},
                                               {along_u, -outward, -along_v},
                                               {along_u, -along_v, outward},
                                               {-along_u, -along_v, -outward}}};
            for (std::uint32_t face = 0; face < kCubeFaces; ++face) {
                moment[(std::size_t{face} * n + row) * n + column] = by_face[face];
            }
        }
    }
    return moment;
}

}  // namespace opaline::formats
