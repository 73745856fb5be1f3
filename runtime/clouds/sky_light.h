#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

inline constexpr std::size_t kMaxLayerSuns = 2;

/// A small light above the horizon.
struct LayerSun {
    formats::Vec3 direction;   ///< unit, toward the light's part above the horizon, world; y > 0
    formats::Rgb irradiance;   ///< on a plane facing it [W m^-2], of the part above the horizon
    float angular_radius = 0;  ///< [rad], of the whole light; of a disc with the same spread
};

/// Distant light as a cloud layer takes it: suns, and the rest, the sky. Light from below the
/// horizon is left out, as the ground is there.
struct SkyLight {
    std::vector<LayerSun> suns;  ///< at most kMaxLayerSuns, strongest first
    formats::Rgb irradiance;     ///< of the rest, on a horizontal plane [W m^-2]
    formats::Rgb horizon;        ///< mean radiance of the map's rest up to 6 degrees above it

    /// The sun of a map: luminance above sun_luminance in directions d with dot(d, peak) >
    /// peak_cosine. Infinity: the map has no sun.
    float sun_luminance = std::numeric_limits<float>::infinity();
    formats::Vec3 peak{0, 1, 0};  ///< unit, world
    float peak_cosine = 1;
    std::vector<std::uint32_t> sun_discs;  ///< the suns among Environment::discs
};

/// The environment's discs become suns. An environment without a disc may have a sun in its map
/// (map_peak.h). A light across the horizon counts with its part above, so that all values are
/// continuous as the light turns; discs beyond kMaxLayerSuns belong to the rest. Suns and rest
/// together have the irradiance of the whole on a horizontal plane, to 0.1 % for maps with texels
/// below 3 degrees. Precondition: the environment's values are finite and not negative.
SkyLight split_sky(const formats::Environment& environment, const Rotation& rotation);

/// Radiance of the map in a unit direction of the world, without its sun and without discs.
formats::Rgb map_rest(const SkyLight& sky, const formats::Environment& environment,
                      const Rotation& rotation, formats::Vec3 direction);

/// Radiance in a unit direction of the world, without the suns and of the suns alone. Their sum is
/// sample_radiance. `environment` and `rotation` are those of split_sky.
formats::Rgb rest_radiance(const SkyLight& sky, const formats::Environment& environment,
                           const Rotation& rotation, formats::Vec3 direction);
formats::Rgb sun_part(const SkyLight& sky, const formats::Environment& environment,
                      const Rotation& rotation, formats::Vec3 direction);

}  // namespace opaline::runtime
