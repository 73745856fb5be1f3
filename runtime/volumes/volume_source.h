#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/opal/rgb.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/volumes.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/sun_phase.h"
#include "runtime/volumes/suns.h"

namespace opaline::runtime {

/// Source radiance between nodes, as rays and single points evaluate it. Inline: a march spends
/// its time here.

/// Beyond these a colour or an extinction [1/m] has no use, and products of both still fit.
inline constexpr float kLargestSource = 1e20f, kLargestExtinction = 1e15f;

/// What the coefficients of a volume count for: those of its nodes, then those of suns.
using SourceWeights = std::array<float, formats::kMaxHarmonics + kMaxSunTerms * kMaxSuns>;

/// For the unit direction `to_eye`: Y_k of it, then the tables of the volume's SunPhase between
/// each sun's light and the eye.
SourceWeights source_weights(const VolumeLight& light, std::size_t volume, formats::Vec3 to_eye);

/// For the mean over all directions: Y_0, and the means of the tables.
SourceWeights mean_weights(const VolumeLight& light, std::size_t volume);

/// Into [0, largest]; NaN fails the comparison and becomes 0.
inline float tame(float value, float largest) {
    return value > 0 ? std::min(value, largest) : 0.0f;
}
inline formats::Rgb tame(formats::Rgb c, float largest) {
    return {tame(c.r, largest), tame(c.g, largest), tame(c.b, largest)};
}

/// Nothing between a place and the eye.
inline constexpr SunThrough kAllThrough{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};

/// Harmonics of a node; 0 for kNoNode.
inline formats::Rgb eval_node(const VolumeLight& light, std::size_t volume, std::uint32_t node,
                              const SourceWeights& weight) {
    formats::Rgb source;
    if (node == formats::kNoNode) return source;
    const auto c = light.coefficients(volume, node);
    for (std::size_t k = 0; k < c.size(); ++k) {
        source = source + weight[k] * c[k];
    }
    return source;
}

/// Contribution of suns to J at a point of a brick by term; each term is attenuated differently
/// between the point and the eye.
using SunSource = std::array<formats::Rgb, kMaxSunTerms>;

inline SunSource eval_suns(const VolumeLight& light, std::size_t volume, std::uint32_t brick,
                           std::size_t point, const SourceWeights& weight) {
    const VolumeLight::Part& part = light.part[volume];
    const auto c = light.sun_coefficients(volume, brick, point);
    SunSource source{};
    for (std::size_t j = 0, k = 0; j < part.sun_terms; ++j) {
        for (std::size_t s = 0; s < part.suns; ++s, ++k) {
            source[j] = source[j] + weight[part.terms + k] * c[k];
        }
    }
    return source;
}

/// The points at the corners of a box, by number as NodeCell has it, in the order x + 2 y + 4 z.
inline std::array<std::size_t, 8> points_of_box(std::uint32_t boxes, std::uint32_t number) {
    const std::size_t side = std::size_t{boxes} + 1;
    const std::size_t x = number % boxes, y = number / boxes % boxes, z = number / boxes / boxes;
    std::array<std::size_t, 8> points{};
    for (std::size_t i = 0; i < 8; ++i) {
        points[i] = ((z + (i >> 2)) * side + y + (i >> 1 & 1)) * side + x + (i & 1);
    }
    return points;
}

/// Weights of eight corners in that order, from those of the upper ones along each axis, in [0, 1].
inline std::array<float, 8> corner_weights(const std::array<float, 3>& upper) {
    std::array<float, 8> weight{};
    for (std::size_t i = 0; i < 8; ++i) {
        weight[i] = 1;
        for (std::size_t a = 0; a < 3; ++a) {
            weight[i] *= (i >> a & 1) != 0 ? upper[a] : 1 - upper[a];
        }
    }
    return weight;
}

inline formats::Rgb mix_nodes(const std::array<formats::Rgb, 8>& source,
                              const std::array<float, 3>& upper) {
    const std::array<float, 8> weight = corner_weights(upper);
    formats::Rgb mixed;
    for (std::size_t i = 0; i < 8; ++i) {
        mixed = mixed + weight[i] * source[i];
    }
    return mixed;
}

/// Between eight points: of the first `terms` parts the sum, `through` of each of which counts.
inline formats::Rgb mix_suns(const std::array<SunSource, 8>& source, std::uint32_t terms,
                             const std::array<float, 3>& upper, const SunThrough& through) {
    const std::array<float, 8> weight = corner_weights(upper);
    formats::Rgb sum;
    for (std::size_t j = 0; j < terms; ++j) {
        formats::Rgb mixed;
        for (std::size_t i = 0; i < 8; ++i) {
            mixed = mixed + weight[i] * source[i][j];
        }
        sum = sum + through[j] * mixed;
    }
    return sum;
}

}  // namespace opaline::runtime
