#include "formats/image/image_kind.h"

#include <cstring>
#include <string_view>

namespace opaline::formats {

ImageKind image_kind(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    using namespace std::string_view_literals;
    if (text.starts_with("\x76\x2f\x31\x01"sv)) return ImageKind::exr;
    if (text.starts_with("#?"sv)) return ImageKind::hdr;
    if (text.starts_with("\x89PNG\r\n\x1a\n"sv)) return ImageKind::png;
    return ImageKind::unknown;
}

bool is_plausible_size(std::uint64_t width, std::uint64_t height, std::uint64_t file_bytes) {
    if (width == 0 || height == 0 || width > kMaxImagePixels || height > kMaxImagePixels) {
        return false;
    }
    const std::uint64_t pixels = width * height;
    constexpr std::uint64_t kHarmless = std::uint64_t{1} << 24, kMostPerByte = 16;
    return pixels <= kMaxImagePixels &&
           (pixels <= kHarmless || pixels / kMostPerByte <= file_bytes);
}

}  // namespace opaline::formats
