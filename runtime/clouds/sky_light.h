#pragma once

#include <cstddef>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// A small bright light far away.
struct SkySun {
    formats::Vec3 direction{0, 1, 0};  ///< unit, toward the sun, world; y > 0
    formats::Rgb irradiance;           ///< on a plane facing it [W/m^2], >= 0
    float angular_radius = 0;          ///< [rad], in (0, pi / 2)
};

inline constexpr std::size_t kMaxSkySuns = 2;

/// An environment as cloud layers are lit by it: suns and an even rest. What comes from below the
/// horizon is not in it: the ground stands there.
struct SkyLight {
    std::vector<SkySun> suns;     ///< kMaxSkySuns at most
    formats::Rgb irradiance;      ///< of the rest, on a horizontal plane [W/m^2]
    formats::Rgb horizon;         ///< mean radiance of the rest near the horizon [W m^-2 sr^-1]
    float sun_luminance = 1e30f;  ///< of the map: what is above it belongs to a sun
};

}  // namespace opaline::runtime
