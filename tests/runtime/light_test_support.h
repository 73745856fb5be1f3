#pragma once

#include <cmath>

#include "formats/opal/haar.h"
#include "runtime/light_vector.h"
#include "tests/support/sky_maps.h"

namespace opaline::tests {

/// A smooth sky of high dynamic range: a gradient, and a lobe of 200 times its brightness with a
/// width of 0.2 rad.
inline formats::Rgb smooth_sky(formats::Vec3 d) {
    const float lobe =
        200.0f * std::exp(50.0f * (dot(d, formats::normalize({0.3f, 0.7f, 0.5f})) - 1.0f));
    return {1.0f + 0.5f * d.y + lobe, 1.0f + 0.3f * d.x + 0.8f * lobe, 1.2f - 0.5f * d.z * d.x};
}

/// |a - b| / |b| over all coefficients and bands.
inline double relative_difference(const runtime::LightVector& a, const runtime::LightVector& b) {
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        difference += std::pow(double{a.rgba[i]} - double{b.rgba[i]}, 2);
        norm += std::pow(double{b.rgba[i]}, 2);
    }
    return std::sqrt(difference / norm);
}

/// Texel integrals of one band, back from the coefficients.
inline std::vector<double> texels_of(const runtime::LightVector& light, std::size_t band) {
    const std::uint32_t n = light.n, size = n * n;
    std::vector<double> texels(formats::cubemap_texels(n)), scratch(size);
    for (std::size_t k = 0; k < texels.size(); ++k) {
        texels[k] = light.rgba[4 * k + band];
    }
    for (std::size_t face = 0; face < 6; ++face) {
        formats::haar_inverse(std::span<double>(texels).subspan(face * size, size), n, scratch);
    }
    return texels;
}

/// Integral of one band of radiance over the sphere: each face's average times n, summed.
inline double flux(const runtime::LightVector& light, std::size_t band) {
    double sum = 0;
    for (std::size_t face = 0; face < 6; ++face) {
        sum += double{light.rgba[4 * face * light.n * light.n + band]} * light.n;
    }
    return sum;
}

}  // namespace opaline::tests
