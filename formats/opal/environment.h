#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"

namespace opaline::formats {

/// A uniform disc of light at infinity: the sun. Kept apart from the map, whose pixels are too
/// coarse for it.
struct DistantDisc {
    Vec3 direction{0, 1, 0};   ///< unit, toward the disc's centre
    float angular_radius = 0;  ///< [rad], in (0, pi/2)
    Rgb radiance;  ///< [W m^-2 sr^-1], >= 0; irradiance facing it = radiance * solid angle
};

/// 2 pi (1 - cos r), without cancellation for small r.
double disc_solid_angle(float angular_radius);

/// Distant lighting: a map of radiance in world directions plus discs that add to it.
/// Radiance is linear Rec. 709, finite, >= 0.
struct Environment {
    enum class Layout : std::uint32_t {
        lat_long,  ///< width x height, row 0 up
        cube       ///< n x 6n: the six faces below each other, in cubemap.h order and orientation
    } layout = Layout::lat_long;
    std::uint32_t width = 0, height = 0;
    std::vector<Rgb> pixel;  ///< row-major; empty: no map, only discs

    /// Lat-long maps: u = u_offset + u_sign * atan2(z, x) / (2 pi), pixel centres at
    /// ((column + 1/2) / width). Default: the centre of the image is +X (three.js, Blender).
    float u_offset = 0.5f, u_sign = 1.0f;
    /// Lat-long maps: rows at polar angle pi * (row + 1/2) / height, or with the poles included at
    /// pi * row / (height - 1) (the OpenEXR convention).
    bool rows_include_poles = false;

    std::vector<DistantDisc> discs;
};

/// Radiance of the map alone (no discs) in a unit direction: bilinear; lat-long maps wrap in u and
/// clamp in v; cube maps are interpolated across edges by direction.
Rgb sample_map(const Environment& environment, Vec3 direction);

/// Radiance including the discs: what a camera sees.
Rgb sample_radiance(const Environment& environment, Vec3 direction);

}  // namespace opaline::formats
