#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace opaline::formats {

inline constexpr std::uint32_t kNoImage = 0xffffffffu;

/// How an image is looked up along one axis: how a coordinate outside [0, 1] is brought back
/// inside, and whether values between texels are linear, or those of the texel that the coordinate
/// is in.
enum class Wrap : std::uint32_t {
    repeat = 0,
    clamp = 1,
    mirror = 2,
    nearest_repeat = 4,
    nearest_clamp = 5,
    nearest_mirror = 6
};

/// The bit of the nearest_ values, and those values.
inline constexpr std::uint32_t kNearestBit = 4;
constexpr bool is_nearest(Wrap wrap) {
    return (static_cast<std::uint32_t>(wrap) & kNearestBit) != 0;
}
/// repeat, clamp or mirror.
constexpr Wrap edge_of(Wrap wrap) {
    return static_cast<Wrap>(static_cast<std::uint32_t>(wrap) & ~kNearestBit);
}
/// Precondition: `edge` is repeat, clamp or mirror.
constexpr Wrap nearest(Wrap edge) {
    return static_cast<Wrap>(static_cast<std::uint32_t>(edge) | kNearestBit);
}
/// Of a number from a file: whether it is one of the enum.
constexpr bool is_known(Wrap wrap) {
    return static_cast<std::uint32_t>(edge_of(wrap)) <= static_cast<std::uint32_t>(Wrap::mirror);
}

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
