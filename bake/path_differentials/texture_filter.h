#pragma once

#include <glm/glm.hpp>

#include "bake/path_differentials/footprint.h"

namespace opaline::bake {

/// Trilinear look-ups whose mean filters a texture over a footprint.
struct TextureTaps {
    int count = 1;
    double level = 0;             ///< of the pyramid, >= 0; the sampler clamps it to the coarsest
    glm::dvec2 axis{0};           ///< the major axis, in texture coordinates
    double major = 0, minor = 0;  ///< [texels]

    /// Where the i-th look-up is, relative to the middle, in texture coordinates.
    glm::dvec2 offset(int i) const { return ((i + 0.5) / count - 0.5) * axis; }
};

/// `in_uv`: the two vectors of a footprint in texture coordinates; `resolution`: texels per unit.
/// With singular values l1 >= l2 of J: n = ceil(l1 / max(l2, 1)) within [1, most_taps], level
/// log2(max(l2, l1 / n, 1)).
TextureTaps texture_taps(const FootprintPair& in_uv, const glm::dvec2& resolution, int most_taps);

/// Level for a grid of coefficients in a volume: log2 of the smallest extent, in cells; 0 below
/// one. Filter extinction and scattering coefficient, never their ratio.
double volume_level(const glm::dvec3& extents, double cell);

}  // namespace opaline::bake
