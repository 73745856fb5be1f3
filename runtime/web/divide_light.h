#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/environment.h"

namespace opaline::runtime {

/// Texels a side of the cube map that a page turns.
inline constexpr std::uint32_t kPageTexels = 128;

/// Distant light as a page projects it.
struct DividedLight {
    /// Mean radiance over the texels of a cube map of kPageTexels a side, without what follows.
    std::vector<formats::Rgb> cube;
    /// Of pixels much brighter than their surroundings, a sun in a photograph: a direction and the
    /// flux from there [W m^-2], 6 floats a point. The flux is exact.
    std::vector<float> points;
    std::vector<formats::DistantDisc> suns;  ///< discs of at most kLargestSun
};

/// Same bits for any number of threads (0: all cores).
DividedLight divide_light(const formats::Environment& environment, unsigned threads);

}  // namespace opaline::runtime
