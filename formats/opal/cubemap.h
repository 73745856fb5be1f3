#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/vec3.h"

namespace opaline::formats {

/// Cube map convention (contract): six faces of n x n texels, OpenGL order +X -X +Y -Y +Z -Z and
/// OpenGL orientation (specification table "Selection of cube map images"; row 0 at t = 0).
/// A texel's index is (face * n + row) * n + column; its centre lies at ((column + 1/2) / n,
/// (row + 1/2) / n) in (s, t).

inline constexpr std::uint32_t kCubeFaces = 6;
inline constexpr std::uint32_t kMinCubemapSize = 8;
inline constexpr std::uint32_t kMaxCubemapSize = 128;

inline constexpr std::uint32_t cubemap_texels(std::uint32_t n) {
    return kCubeFaces * n * n;
}

/// True for the sizes a light basis may have: powers of two in [8, 128].
inline constexpr bool is_valid_cubemap_size(std::uint32_t n) {
    return n >= kMinCubemapSize && n <= kMaxCubemapSize && (n & (n - 1)) == 0;
}

/// A point on the cube: u = 2 s - 1 and v = 2 t - 1, both in [-1, 1].
struct CubePoint {
    std::uint32_t face = 0;
    float u = 0, v = 0;
};

/// The point of the cube's surface, not normalised: its largest coordinate is 1 in magnitude.
Vec3 cube_position(CubePoint point);

/// Inverse of `cube_position` for any non-zero direction.
CubePoint cube_point(Vec3 direction);

/// Unit direction of a texel's centre.
Vec3 texel_direction(std::uint32_t n, std::uint32_t face, std::uint32_t row, std::uint32_t column);

/// Index of the texel that a direction falls into.
std::uint32_t texel_index(std::uint32_t n, Vec3 direction);

/// Exact solid angle [sr] of the rectangle [u0, u1] x [v0, v1] of any face.
/// f(u1,v1) - f(u0,v1) - f(u1,v0) + f(u0,v0) with f = atan2(uv, sqrt(u^2+v^2+1)).
double rectangle_solid_angle(double u0, double v0, double u1, double v1);

/// Solid angle [sr] of every texel of one face (all faces are alike); n * n values, sum 4 pi / 6.
std::vector<double> texel_solid_angles(std::uint32_t n);

/// First moment of a texel, integral of w over its solid angle [sr]: the exact irradiance vector of
/// unit radiance through that texel, so that dot(normal, moment) integrates the cosine without
/// quadrature error wherever the texel lies above the horizon. 6 n n values.
/// Closed form of a spherical polygon (Lambert): 1/2 sum of edge angle times edge normal.
std::vector<Vec3> texel_moments(std::uint32_t n);

}  // namespace opaline::formats
