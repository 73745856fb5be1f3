#include "bake/scene/color_contrast.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "formats/image/srgb.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

struct Range {
    Rgb low{1, 1, 1}, high{0, 0, 0};

    void add(Rgb c) {
        low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
        high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b)};
    }
};

Range range_of_image(const formats::Image8& image) {
    std::array<std::uint8_t, 3> low{255, 255, 255}, high{0, 0, 0};
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        for (std::size_t band = 0; band < 3; ++band) {
            low[band] = std::min(low[band], image.rgba[i + band]);
            high[band] = std::max(high[band], image.rgba[i + band]);
        }
    }
    const auto decode = [](const std::array<std::uint8_t, 3>& code) {
        const auto linear = [](std::uint8_t c) {
            return formats::linear_from_srgb(static_cast<float>(c) / 255);
        };
        return Rgb{linear(code[0]), linear(code[1]), linear(code[2])};
    };
    return {decode(low), decode(high)};
}

}  // namespace

ColorRange find_color_range(const formats::Scene& scene, std::uint32_t material) {
    Range vertex;
    for (const formats::Primitive& primitive : scene.primitives) {
        if (primitive.material != material) {
            continue;
        }
        if (primitive.color.empty()) {
            vertex.add({1, 1, 1});
        }
        for (const Rgb c : primitive.color) {
            vertex.add(c);
        }
    }
    const formats::Material& m = scene.materials[material];
    Rgb low = vertex.low, high = vertex.high;
    if (m.base_color_image != formats::kNone) {
        const Range image = range_of_image(scene.images[m.base_color_image]);
        low = low * image.low;
        high = high * image.high;
    }
    if (m.marble) {
        Range veins;
        for (const Rgb c : m.marble->colors) {
            veins.add(c);
        }
        low = low * veins.low;
        high = high * veins.high;
    }
    return {std::max({vertex.high.r, vertex.high.g, vertex.high.b}),
            std::max({0.0f, high.r - low.r, high.g - low.g, high.b - low.b})};
}

}  // namespace opaline::bake
