#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// Distant light in the asset's basis: coefficient k is rgba[4 k .. 4 k + 3] = (r, g, b, 0),
/// ordered as in formats/opal/haar.h, 6 n n coefficients. Unit: radiance times solid angle [W
/// m^-2], since the light carries the solid angle (formats/README.md, "Pairing"): light =
/// Haar(dOmega_j * mean radiance of texel j). Four floats a coefficient, so that one aligned load
/// fetches the three bands and a GPU buffer takes the array as it is.
struct LightVector {
    std::uint32_t n = 0;
    std::vector<float> rgba;
};

/// Proper rotation: where the light's axes stand in the world.
struct Rotation {
    formats::Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    formats::Vec3 world_from_light(formats::Vec3 d) const { return d.x * x + d.y * y + d.z * z; }
    formats::Vec3 light_from_world(formats::Vec3 d) const {
        return {dot(x, d), dot(y, d), dot(z, d)};
    }
};

/// Counter-clockwise seen from above: turns +Z toward +X.
Rotation rotation_about_y(float radians);

/// True if the axes are orthonormal to `tolerance` and right-handed.
bool is_rotation(const Rotation& rotation, float tolerance = 1e-4f);

/// Projects a map and its discs on the cube map of n x n texels and on the Haar basis.
/// Preconditions: n is a valid cube map size (cubemap.h); the map's pixel count agrees with its
/// size, its radiance is finite and not negative. `threads` 0: all cores; the result has the same
/// bits for any number. How the map is integrated: integrate_map.h; discs: integrate_discs.h.
LightVector project_environment(const formats::Environment& environment, std::uint32_t n,
                                const Rotation& rotation = {}, unsigned threads = 0);

/// The mean radiance of each texel of a cube map in the asset's own resolution, unrotated;
/// 6 n n values in cubemap.h order and orientation.
LightVector project_cubemap(std::span<const formats::Rgb> radiance, std::uint32_t n);

/// Haar transform of texel integrals: integral[3 j + band] over texel j [W m^-2], 6 n n texels.
LightVector make_light_vector(std::span<const double> integral, std::uint32_t n);

/// The same into a vector of that n; `scratch` holds at least 2 n n values. Never allocates.
void fill_light_vector(std::span<const double> integral, std::span<double> scratch,
                       LightVector& light);

}  // namespace opaline::runtime
