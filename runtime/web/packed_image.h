#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::runtime {

/// An image of three 16-bit numbers a pixel, without loss, in a fraction of its bytes where it is
/// smooth. `unpack` of page/data.js reads it.
///
/// Each number is predicted from those of its band to the left (a), above (b) and left above (c):
/// a + b - c, within the range of a and b, as JPEG-LS does (ITU-T T.87, A.4.2). What is left,
/// folded as 0, -1, 1, -2, ... to 0, 1, 2, 3, ..., stands in blocks of 16, each with four bits k
/// before it: 15 means 16 zeros; otherwise each number is Rice's code of parameter k. The first bit
/// of a byte is its highest. `width` [pixels] > 0.
std::vector<std::byte> pack_image(std::span<const std::uint16_t> values, std::uint32_t width);

}  // namespace opaline::runtime
