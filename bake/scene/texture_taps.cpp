#include "bake/scene/texture_taps.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {

TextureTaps texture_taps(const UvMoments& moments, glm::dvec2 resolution, int most_taps) {
    const double a = moments.uu * resolution.x * resolution.x;
    const double b = moments.uv * resolution.x * resolution.y;
    const double c = moments.vv * resolution.y * resolution.y;
    const double half = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
    const double major = 0.5 * (a + c) + half;
    TextureTaps taps;
    if (!(major > 0) || !std::isfinite(major)) return taps;
    taps.major = std::sqrt(major);
    taps.minor = std::sqrt(std::max((a * c - b * b) / major, 0.0));
    const double wanted = std::ceil(taps.major / std::max(taps.minor, 1.0));
    taps.count = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most_taps)));
    taps.level = std::log2(std::max({taps.minor, taps.major / taps.count, 1.0}));
    // Of the two forms of the eigenvector the one without cancellation.
    const glm::dvec2 e = a > c ? glm::dvec2(major - c, b) : glm::dvec2(b, major - a);
    const double square = glm::dot(e, e);
    taps.axis = square > 0 ? std::sqrt(major / square) * e / resolution
                           : glm::dvec2(taps.major / resolution.x, 0);  // round
    return taps;
}

}  // namespace opaline::bake
