#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "formats/opal/rgb.h"

namespace opaline::formats {

/// Three channels in 32 bits, as OpenGL's RGB9_E5: mantissas of 9 bits, red lowest, and an exponent
/// e in bits 27 to 31 that they share; a channel is mantissa * 2^(e - 24).
inline constexpr float kLargestShared = 65408;  ///< 511 * 2^7

/// The nearest code: each channel errs by at most 2^-9 of the largest one, and by 2^-25. Values
/// beyond the range are cut. Precondition: not NaN.
inline std::uint32_t pack_shared(Rgb c) {
    const auto cut = [](float v) { return std::clamp(v, 0.0f, kLargestShared); };
    const Rgb v{cut(c.r), cut(c.g), cut(c.b)};
    const float most = std::max({v.r, v.g, v.b});
    int e = most > 0 ? std::max(std::ilogb(most) + 16, 0) : 0;
    // The largest mantissa may round up to 512.
    if (std::lround(std::ldexp(most, 24 - e)) > 511) ++e;
    const auto code = [&](float x) {
        return static_cast<std::uint32_t>(std::lround(std::ldexp(x, 24 - e)));
    };
    return code(v.r) | code(v.g) << 9 | code(v.b) << 18 | static_cast<std::uint32_t>(e) << 27;
}

/// Exact.
inline Rgb unpack_shared(std::uint32_t code) {
    const float step = std::ldexp(1.0f, static_cast<int>(code >> 27) - 24);
    const auto channel = [&](unsigned shift) {
        return step * static_cast<float>(code >> shift & 511u);
    };
    return {channel(0), channel(9), channel(18)};
}

/// IEEE 754 half precision: 11 significant bits, 6.1e-5 ... 65504 in full precision.
inline constexpr float kLargestHalf = 65504;

/// Infinity or NaN.
constexpr bool is_half_finite(std::uint16_t half) {
    return (half & 0x7c00u) != 0x7c00u;
}

/// Exact; infinities and NaN become those of float.
constexpr float float_from_half(std::uint16_t half) {
    const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16;
    const std::uint32_t bits = static_cast<std::uint32_t>(half & 0x7fffu) << 13;
    if ((half & 0x7c00u) == 0x7c00u) return std::bit_cast<float>(sign | bits | 0x7f800000u);
    // Exponents are 112 apart; the product is exact for subnormal halves too.
    const float magnitude = std::bit_cast<float>(bits) * 0x1p112f;
    return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(magnitude));
}

/// The nearest half, ties to even. Precondition: finite, at most kLargestHalf in absolute value.
constexpr std::uint16_t half_from_float(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude < 0x38800000u) {  // below 2^-14: the float sum rounds to multiples of 2^-24
        const float sum = std::bit_cast<float>(magnitude) + 0.5f;
        return static_cast<std::uint16_t>(sign | (std::bit_cast<std::uint32_t>(sum) - 0x3f000000u));
    }
    const std::uint32_t rounded = magnitude + 0xfffu + (magnitude >> 13 & 1u);
    return static_cast<std::uint16_t>(sign | ((rounded - 0x38000000u) >> 13));
}

}  // namespace opaline::formats
