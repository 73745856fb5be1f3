#pragma once

#include <glm/glm.hpp>

#include "formats/image/image.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Second moments of a footprint in texture coordinates: sum of d d^T over its vectors d. A box on
/// the axes, as long as the roots of the eigenvalues, has 12 times its moments.
struct UvMoments {
    double uu = 0, uv = 0, vv = 0;

    void add(glm::dvec2 d) {
        uu += d.x * d.x;
        uv += d.x * d.y;
        vv += d.y * d.y;
    }
};

/// Trilinear look-ups whose mean filters a texture over a footprint.
struct TextureTaps {
    int count = 1;
    double level = 0;             ///< of the pyramid, >= 0; the sampler clamps it to the coarsest
    glm::dvec2 axis{0};           ///< the major axis, in texture coordinates
    double major = 0, minor = 0;  ///< [texels]

    /// Where the i-th look-up is, relative to the middle, in texture coordinates.
    glm::dvec2 offset(int i) const { return ((i + 0.5) / count - 0.5) * axis; }
};

/// `resolution`: texels per unit. With the roots l1 >= l2 of the eigenvalues of the moments in
/// texels, which are the singular values of two vectors that span the footprint: n = ceil(l1 /
/// max(l2, 1)) within [1, most_taps], level log2(max(l2, l1 / n, 1)). A footprint that is not
/// finite is a point.
TextureTaps texture_taps(const UvMoments& moments, glm::dvec2 resolution, int most_taps);

/// An image and how it is looked up.
struct ImageLookup {
    const formats::Image8& image;  ///< not empty
    formats::TextureWrap wrap_u, wrap_v;
    bool is_linear;  ///< red, green and blue are values times 255; else sRGB. Alpha is linear
};

/// Bilinear in linear light, or the nearest texel where the wrap modes say so; texel centres at
/// ((column + 1/2) / width, (row + 1/2) / height), uv (0, 0) at the top left. Coordinates beyond a
/// million sample at 0: there, floats do not resolve texels.
glm::vec4 sample_image(const ImageLookup& lookup, glm::vec2 uv);

/// Its alpha alone.
float sample_alpha(const ImageLookup& lookup, glm::vec2 uv);

}  // namespace opaline::bake
