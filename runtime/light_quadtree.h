#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"

namespace opaline::runtime {

using Double3 = std::array<double, 3>;

inline void add(Double3& sum, double weight, const Double3& value) {
    for (std::size_t i = 0; i < 3; ++i) {
        sum[i] += weight * value[i];
    }
}

/// Texels of a cube map face that are taken together.
struct LightCell {
    Double3 flux{};        ///< integral of radiance over the cell [W m^-2]
    formats::Vec3 centre;  ///< unit
    float solid_angle = 0;
    formats::Vec3 flux_centre;  ///< unit, weighted with light: a lone sun stays in its place
    /// Mean squared distance of directions from their mean, 1 - |mean|^2: of the cell, and weighted
    /// with its light (0 where it has none).
    float spread = 0, flux_spread = 0;
};

/// A quadtree over each face: level l has 2^l x 2^l cells a face, in cubemap.h order.
struct LightQuadtree {
    std::vector<std::vector<LightCell>> level;
};

/// From the integrals of radiance over the texels of a cube map, integral[3 j + band], 6 n n
/// texels. Same bits for any number of threads (0: all cores).
LightQuadtree make_light_quadtree(std::span<const double> integral, std::uint32_t n,
                                  unsigned threads);

}  // namespace opaline::runtime
