#pragma once

#include <algorithm>
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

}  // namespace opaline::formats
