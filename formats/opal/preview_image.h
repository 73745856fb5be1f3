#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace opaline::formats {

inline constexpr std::uint32_t kNoImage = 0xffffffffu;

/// How a texture coordinate outside [0, 1] is brought back inside.
enum class Wrap : std::uint32_t { repeat = 0, clamp = 1, mirror = 2 };

/// Three bytes a pixel, row 0 on top: 8-bit sRGB colour, or linear values where a GlossRecord uses
/// it.
struct PreviewImage {
    std::uint32_t width = 0, height = 0;
    std::span<const std::uint8_t> rgb;
};

/// Owning twin of `PreviewImage`.
struct PreviewImageData {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

}  // namespace opaline::formats
