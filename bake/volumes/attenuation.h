#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/transport/ray_scene.h"
#include "bake/volumes/density_space.h"
#include "bake/volumes/light_cells.h"

namespace opaline::bake {

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
    std::vector<bool> is_dark;        ///< points that no light reaches unscattered

    const std::uint16_t* codes(std::size_t point, std::size_t band) const {
        return code.data() + (point * bands + band) * cells;
    }
};

/// An empty table of `points` points.
DepthTable make_depth_table(std::size_t points, std::size_t cells, std::size_t bands);

/// Fills in one band of one point from V. Any thread may set another point's codes; is_dark is not
/// touched.
void set_depths(DepthTable& table, std::size_t point, std::size_t band,
                std::span<const float> attenuation);

}  // namespace opaline::bake
