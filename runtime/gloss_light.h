#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// Distant light as the lobes of glossy opaque surfaces sum it up (gloss_model.h), in the light's frame.
/// The same light three times over: narrow lobes sample maps, wide ones sum cells; suns, too small
/// for either, are added to both.
struct GlossLight {
    /// Cube maps of mean radiance [W m^-2 sr^-1], 128, 64, ... 1 texels a side; empty: no light was
    /// prepared, and glossy opaque surfaces reflect none.
    std::vector<formats::Environment> map;

    /// The sphere in at most kLightCells cells, small where there is much light; one array per
    /// value, padded with empty cells to a multiple of kCellBlock.
    struct Cells {
        std::vector<float> x, y, z;      ///< unit direction of the cell's light
        std::vector<float> solid_angle;  ///< [sr]
        std::vector<float> widening;     ///< what its size adds to a lobe's alpha^2
        std::vector<float> r, g, b;      ///< flux: integral of radiance [W m^-2]

        std::size_t size() const { return x.size(); }
    } cells;

    std::vector<formats::DistantDisc> suns;  ///< discs of at most kLargestSun
};

inline constexpr std::size_t kLightCells = 2048, kCellBlock = 8;

/// Angular radius up to which a disc counts as a sun [rad]: a lobe widened by it is a good
/// approximation of the lobe's integral over the disc. Larger discs go into maps and cells.
inline constexpr float kLargestSun = 0.02f;

/// Texels a side of the finest map.
inline constexpr std::uint32_t kGlossTexels = 128;

/// `integral`: of a map over 6 * 128 * 128 texels [W m^-2], integral[3 j + band], in the light's
/// frame, without discs. Values are finite whatever finite light there is. Same bits for any number
/// of threads (0: all cores).
GlossLight make_gloss_light(std::span<const double> integral,
                            std::span<const formats::DistantDisc> discs, unsigned threads);

/// The same, of a map and its discs.
GlossLight make_gloss_light(const formats::Environment& environment, unsigned threads);

}  // namespace opaline::runtime
