#include "formats/image/srgb.h"

#include <array>
#include <cmath>

namespace opaline::formats {

float linear_from_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_from_linear(float linear) {
    if (!(linear > 0.0f)) return 0.0f;
    if (linear >= 1.0f) return 1.0f;
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

Image to_linear(const Image8& image) {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = linear_from_srgb(static_cast<float>(i) / 255.0f);
    }
    Image result{image.width, image.height, {}};
    result.pixel.reserve(image.rgba.size() / 4);
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        result.pixel.push_back(
            {table[image.rgba[i]], table[image.rgba[i + 1]], table[image.rgba[i + 2]]});
    }
    return result;
}

Image8 to_srgb(const Image& image) {
    const auto code = [](float linear) {
        return static_cast<std::uint8_t>(255.0f * srgb_from_linear(linear) + 0.5f);
    };
    Image8 result{image.width, image.height, {}};
    result.rgba.reserve(image.pixel.size() * 4);
    for (const Rgb& c : image.pixel) {
        result.rgba.insert(result.rgba.end(), {code(c.r), code(c.g), code(c.b), 255});
    }
    return result;
}

}  // namespace opaline::formats
