#include "runtime/texture.h"

#include <array>
#include <cmath>

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Wrap;

std::array<float, 256> make_srgb_table() {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < table.size(); ++code) {
        const double encoded = static_cast<double>(code) / 255.0;
        table[code] = static_cast<float>(
            encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    return table;
}

// The two columns (or rows) that a coordinate lies between, and the share of the second.
struct Taps {
    std::uint32_t first = 0, second = 0;
    float share = 0;
};

std::uint32_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
    switch (formats::edge_of(wrap)) {
        case Wrap::clamp:
            i = i < 0 ? 0 : (i >= size ? size - 1 : i);
            break;
        case Wrap::mirror:
            i = ((i % (2 * size)) + 2 * size) % (2 * size);
            i = i < size ? i : 2 * size - 1 - i;
            break;
        default:
            i = ((i % size) + size) % size;
            break;
    }
    return static_cast<std::uint32_t>(i);
}

Taps find_taps(float coordinate, std::uint32_t size, Wrap wrap) {
    if (!std::isfinite(coordinate)) {
        coordinate = 0;
    }
    // Brought into one period first: a large coordinate would not fit an integer. Two periods are
    // one of the mirrored image.
    double x = static_cast<double>(coordinate);
    x = formats::edge_of(wrap) == Wrap::clamp ? std::fmin(std::fmax(x, 0.0), 1.0)
                                              : x - 2.0 * std::floor(0.5 * x);
    const double scaled = formats::is_nearest(wrap) ? std::floor(x * size) : x * size - 0.5;
    const double below = std::floor(scaled);
    const auto i = static_cast<std::int64_t>(below);
    return {wrapped(i, size, wrap), wrapped(i + 1, size, wrap), static_cast<float>(scaled - below)};
}

const std::array<float, 256>& srgb_table() {
    static const std::array<float, 256> kTable = make_srgb_table();
    return kTable;
}

template <class Decode>
Rgb sample_image(const formats::PreviewImage& image, const Taps& x, const Taps& y, Decode decode) {
    const auto texel = [&](std::uint32_t column, std::uint32_t row) {
        const auto rgb = image.rgb.subspan((std::size_t{row} * image.width + column) * 3, 3);
        return Rgb{decode(rgb[0]), decode(rgb[1]), decode(rgb[2])};
    };
    const Rgb above =
        (1.0f - x.share) * texel(x.first, y.first) + x.share * texel(x.second, y.first);
    const Rgb below =
        (1.0f - x.share) * texel(x.first, y.second) + x.share * texel(x.second, y.second);
    return (1.0f - y.share) * above + y.share * below;
}

}  // namespace

float linear_from_srgb(std::uint8_t code) {
    return srgb_table()[code];
}

Rgb sample_image_linear(const formats::PreviewImage& image, formats::Float2 uv, Wrap wrap_u,
                        Wrap wrap_v) {
    const std::array<float, 256>& linear = srgb_table();
    return sample_image(image, find_taps(uv.x, image.width, wrap_u),
                        find_taps(uv.y, image.height, wrap_v),
                        [&linear](std::uint8_t code) { return linear[code]; });
}

Rgb sample_image_values(const formats::PreviewImage& image, formats::Float2 uv, Wrap wrap_u,
                        Wrap wrap_v) {
    return sample_image(image, find_taps(uv.x, image.width, wrap_u),
                        find_taps(uv.y, image.height, wrap_v),
                        [](std::uint8_t code) { return static_cast<float>(code) / 255.0f; });
}

Rgb vertex_base_color(const formats::AssetView& asset, const formats::PrimitiveRecord& primitive,
                      std::uint32_t vertex) {
    const Rgb color = asset.base_color[vertex];
    if (primitive.base_color_image == formats::kNoImage) return color;
    return color * sample_image_linear(asset.images[primitive.base_color_image],
                                       asset.texcoord[vertex], primitive.wrap_u, primitive.wrap_v);
}

}  // namespace opaline::runtime
