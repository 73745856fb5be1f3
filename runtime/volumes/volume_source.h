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

/// J of a node before max(0, .); 0 for kNoNode. `through`: of each term of suns.
inline formats::Rgb eval_node(const VolumeLight& light, std::size_t volume, std::uint32_t node,
                              const SourceWeights& weight, const SunThrough& through) {
    formats::Rgb sum;
    if (node == formats::kNoNode) return sum;
    const VolumeLight::Part& part = light.part[volume];
    const auto c = light.coefficients(volume, node);
    std::size_t k = 0;
    for (; k < part.terms; ++k) {
        sum = sum + weight[k] * c[k];
    }
    for (std::size_t j = 0; j < part.sun_terms; ++j) {
        formats::Rgb suns;
        for (std::size_t s = 0; s < part.suns; ++s, ++k) {
            suns = suns + weight[k] * c[k];
        }
        sum = sum + through[j] * suns;
    }
    return sum;
}

/// max(0, J) between eight nodes, in the order x + 2 y + 4 z; weights of the upper ones along each
/// axis, in [0, 1]. At most kLargestSource.
inline formats::Rgb mix_nodes(const std::array<formats::Rgb, 8>& source,
                              const std::array<float, 3>& upper) {
    formats::Rgb sum;
    for (std::size_t i = 0; i < 8; ++i) {
        float weight = 1;
        for (std::size_t a = 0; a < 3; ++a) {
            weight *= (i >> a & 1) != 0 ? upper[a] : 1 - upper[a];
        }
        sum = sum + weight * source[i];
    }
    return tame(sum, kLargestSource);
}

}  // namespace opaline::runtime
