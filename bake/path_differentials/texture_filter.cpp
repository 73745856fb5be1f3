#include "bake/path_differentials/texture_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opaline::bake {

TextureTaps texture_taps(const FootprintPair& in_uv, const glm::dvec2& resolution, int most_taps) {
    const FootprintPair texels{in_uv.A * resolution, in_uv.B * resolution};
    const PairExtent extent = pair_extent(texels);
    const double wanted = std::ceil(extent.major / std::max(extent.minor, 1.0));
    TextureTaps taps{.major = extent.major, .minor = extent.minor};
    taps.count = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most_taps)));
    taps.level = std::log2(std::max({extent.minor, extent.major / taps.count, 1.0}));
    taps.axis = rms_pair(std::array{texels.A, texels.B}).A / resolution;
    return taps;
}

double volume_level(const glm::dvec3& extents, double cell) {
    return std::log2(std::max(std::min({extents.x, extents.y, extents.z}) / cell, 1.0));
}

}  // namespace opaline::bake
