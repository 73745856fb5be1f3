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

/// What the coefficients of a volume's nodes count for, in their order; Part::stride() of them.
using SourceWeights = std::array<float, formats::kMaxHarmonics + kMaxSunTerms * kMaxSuns>;

/// For the unit direction `to_eye`: Y_k of it, then the tables of the volume's SunPhase between
/// each sun's light and the eye.
SourceWeights source_weights(const VolumeLight& light, std::size_t volume, formats::Vec3 to_eye);

/// The share of a sun's light that counts as coming along the ray itself, from what stands straight
/// ahead of it: 1 there, falling to 0 at 12 degrees. `sun` and `to_eye`: unit.
float ahead_share(formats::Vec3 sun, formats::Vec3 to_eye);

/// The part of source_weights that comes along the ray; those of harmonics are 0.
SourceWeights ahead_weights(const VolumeLight& light, std::size_t volume, formats::Vec3 to_eye);

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

/// J of a node before max(0, .), apart in what counts alike whatever is between it and the eye:
/// harmonics and the suns' first term, whose power is 0, then the suns' further terms.
using NodeSource = std::array<formats::Rgb, kMaxSunTerms>;

/// 0 for kNoNode.
inline NodeSource eval_node(const VolumeLight& light, std::size_t volume, std::uint32_t node,
                            const SourceWeights& weight) {
    NodeSource source{};
    if (node == formats::kNoNode) return source;
    const VolumeLight::Part& part = light.part[volume];
    const auto c = light.coefficients(volume, node);
    std::size_t k = 0;
    for (; k < part.terms; ++k) {
        source[0] = source[0] + weight[k] * c[k];
    }
    for (std::size_t j = 0; j < part.sun_terms; ++j) {
        for (std::size_t s = 0; s < part.suns; ++s, ++k) {
            source[j] = source[j] + weight[k] * c[k];
        }
    }
    return source;
}

/// J of `terms` parts, `through` of each of which counts.
inline formats::Rgb sum_source(const NodeSource& source, std::uint32_t terms,
                               const SunThrough& through) {
    formats::Rgb sum = source[0];
    for (std::size_t j = 1; j < terms; ++j) {
        sum = sum + through[j] * source[j];
    }
    return sum;
}

/// Between eight nodes, in the order x + 2 y + 4 z; weights of the upper ones along each axis, in
/// [0, 1]. The first `terms` parts.
inline NodeSource mix_nodes(const std::array<NodeSource, 8>& source, std::uint32_t terms,
                            const std::array<float, 3>& upper) {
    NodeSource mixed{};
    for (std::size_t i = 0; i < 8; ++i) {
        float weight = 1;
        for (std::size_t a = 0; a < 3; ++a) {
            weight *= (i >> a & 1) != 0 ? upper[a] : 1 - upper[a];
        }
        for (std::size_t j = 0; j < terms; ++j) {
            mixed[j] = mixed[j] + weight * source[i][j];
        }
    }
    return mixed;
}

}  // namespace opaline::runtime
