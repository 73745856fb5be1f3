#pragma once

#include <bit>
#include <cstdint>

namespace opaline::formats {

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
