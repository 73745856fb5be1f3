#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Directions of distant light: through the centres of a cube map's texels, in its order.
struct LightCells {
    std::uint32_t n = 0;  ///< texels along an edge of a face
    std::vector<float> x, y, z;

    std::size_t size() const { return x.size(); }
    glm::vec3 direction(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// `n`: power of two, 2 or more.
LightCells make_light_cells(std::uint32_t n);

/// Mean of each 2^k x 2^k block of texels: from `fine` texels along an edge to `coarse`, powers of
/// two with coarse <= fine.
std::vector<float> reduce_cells(const std::vector<float>& values, std::uint32_t fine,
                                std::uint32_t coarse);

/// The texel of a cube map of m x m texels that holds texel i of one of n x n, a multiple of m;
/// maps of several bands follow each other in both.
inline std::size_t coarser_texel(std::size_t i, std::size_t n, std::size_t m) {
    const std::size_t column = i % n, row = i / n % n, face = i / n / n, block = n / m;
    return (face * m + row / block) * m + column / block;
}

/// Texel values from Haar coefficients, in place: 6 n n.
void haar_inverse_cube(std::span<float> cube, std::uint32_t n);

/// Haar coefficients of a cube map of n x n texels, made of the texel values of one of m x m, m <=
/// n: every value covers (n / m)^2 texels. `values`: 6 m m; result: 6 n n.
std::vector<float> transform_cells(std::vector<float> values, std::uint32_t m, std::uint32_t n);

/// The share of light from each cell that volumes let through to a point, e^-(optical depth).
/// `out`: bands * cells values, band after band; as many bands as DensitySpace::extinction_bands.
void gather_transmittance(const DensitySpace& space, const LightCells& cells, glm::vec3 position,
                          std::span<float> out);

/// Attenuated light: V(x, l) = e^-(optical depth from x toward l), 0 where a surface blocks the
/// light; `out` as of gather_transmittance. Returns the rays traced.
std::uint64_t gather_attenuation(const DensitySpace& space, const RayScene& rays,
                                 const LightCells& cells, glm::vec3 position, std::span<float> out);

/// Optical depths toward all cells of many points, in 16 bits.
struct DepthTable {
    static constexpr float kLargest = 16;  ///< and all beyond: V < 2e-7
    static constexpr float kStep = kLargest / 65535;

    std::size_t cells = 0, bands = 1;
    std::vector<std::uint16_t> code;  ///< point after point, band after band
    std::vector<float> most;          ///< largest V of each band of each point, as codes are sorted

    const std::uint16_t* codes(std::size_t point, std::size_t band) const {
        return code.data() + (point * bands + band) * cells;
    }
};

/// An empty table of `points` points.
DepthTable make_depth_table(std::size_t points, std::size_t cells, std::size_t bands);

/// Fills in one band of one point from V. Any thread may set another point's codes.
void set_depths(DepthTable& table, std::size_t point, std::size_t band,
                std::span<const float> attenuation);

}  // namespace opaline::bake
