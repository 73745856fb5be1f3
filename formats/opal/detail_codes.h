#pragma once

#include <cstdint>

namespace opaline::formats {

/// What a stored detail code stands for, in units of its band row's detail scale. Of eight bits it
/// is the square root, sign kept: a row's coefficients span orders of magnitude, most are small,
/// and equal steps would lose these. As accurate as sixteen bits in equal steps down to errors of
/// half a per cent of what a row relights (tests/bake/encode).
constexpr std::int32_t detail_value(std::int8_t code) {
    const std::int32_t magnitude = code < 0 ? -code : code;  // no branch: signs are random
    return code * magnitude;
}
constexpr std::int32_t detail_value(std::int16_t code) {
    return code;
}

/// The largest of either kind.
inline constexpr std::int32_t kLargestDetail8 = 127 * 127;
inline constexpr std::int32_t kLargestDetail16 = 32767;

}  // namespace opaline::formats
