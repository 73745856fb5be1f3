#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace opaline::formats {

/// The type of a file by its first bytes; names and extensions do not count.
enum class ImageKind { unknown, exr, hdr, png };

ImageKind image_kind(std::span<const std::byte> bytes);

/// Most pixels that an image file may decode to: 16384 x 8192.
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 27;

/// False for sizes that no honest file of `file_bytes` has, so that a small hostile file cannot
/// cost gigabytes: width or height 0, more than kMaxImagePixels, or more than 16 pixels per
/// stored byte once the image is larger than 16 Mi pixels (200 MB; flat maps of that size compress
/// a hundredfold). Photographs take a byte for two or three pixels at the very least.
bool is_plausible_size(std::uint64_t width, std::uint64_t height, std::uint64_t file_bytes);

}  // namespace opaline::formats
