#include "bake/scene/sample_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "formats/image/srgb.h"

namespace opaline::bake {
namespace {

using formats::TextureWrap;

const std::array<float, 256>& linear_codes() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = formats::linear_from_srgb(static_cast<float>(i) / 255.0f);
        }
        return values;
    }();
    return table;
}

std::uint32_t wrap(std::int64_t i, std::int64_t size, TextureWrap mode) {
    mode = formats::edge_of(mode);
    if (mode == TextureWrap::clamp) {
        i = i < 0 ? 0 : i >= size ? size - 1 : i;
    } else if (mode == TextureWrap::repeat) {
        i = (i % size + size) % size;
    } else {
        const std::int64_t period = 2 * size;
        i = (i % period + period) % period;
        i = i < size ? i : period - 1 - i;
    }
    return static_cast<std::uint32_t>(i);
}

// What `value_of` makes of the codes of four texels, interpolated.
template <class Value>
auto interpolate(const ImageLookup& lookup, glm::vec2 uv, const Value& value_of) {
    const formats::Image8& image = lookup.image;
    constexpr float kLargest = 1e6f;
    if (!(std::abs(uv.x) < kLargest) || !(std::abs(uv.y) < kLargest)) {
        uv = glm::vec2(0);
    }
    const auto place = [](float u, std::uint32_t size, TextureWrap mode) {
        const float scaled = u * static_cast<float>(size);
        return formats::is_nearest(mode) ? std::floor(scaled) : scaled - 0.5f;
    };
    const float x = place(uv.x, image.width, lookup.wrap_u);
    const float y = place(uv.y, image.height, lookup.wrap_v);
    const float x0 = std::floor(x), y0 = std::floor(y), s = x - x0, t = y - y0;
    const auto at = [&](int dx, int dy) {
        const std::uint32_t column =
            wrap(static_cast<std::int64_t>(x0) + dx, image.width, lookup.wrap_u);
        const std::uint32_t row =
            wrap(static_cast<std::int64_t>(y0) + dy, image.height, lookup.wrap_v);
        return value_of(&image.rgba[4 * (std::size_t{row} * image.width + column)]);
    };
    return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

}  // namespace

TextureTaps texture_taps(const UvMoments& moments, glm::dvec2 resolution, int most_taps) {
    const double a = moments.uu * resolution.x * resolution.x;
    const double b = moments.uv * resolution.x * resolution.y;
    const double c = moments.vv * resolution.y * resolution.y;
    const double half = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
    const double major = 0.5 * (a + c) + half;
    TextureTaps taps;
    if (!(major > 0) || !std::isfinite(major)) return taps;
    taps.major = std::sqrt(major);
    taps.minor = std::sqrt(std::max((a * c - b * b) / major, 0.0));
    const double wanted = std::ceil(taps.major / std::max(taps.minor, 1.0));
    taps.count = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most_taps)));
    taps.level = std::log2(std::max({taps.minor, taps.major / taps.count, 1.0}));
    // Of the two forms of the eigenvector the one without cancellation.
    const glm::dvec2 e = a > c ? glm::dvec2(major - c, b) : glm::dvec2(b, major - a);
    const double square = glm::dot(e, e);
    taps.axis = square > 0 ? std::sqrt(major / square) * e / resolution
                           : glm::dvec2(taps.major / resolution.x, 0);  // round
    return taps;
}

glm::vec4 sample_image(const ImageLookup& lookup, glm::vec2 uv) {
    return interpolate(lookup, uv, [&](const std::uint8_t* code) {
        if (lookup.is_linear) return glm::vec4(code[0], code[1], code[2], code[3]) / 255.0f;
        const auto& linear = linear_codes();
        return glm::vec4(linear[code[0]], linear[code[1]], linear[code[2]],
                         static_cast<float>(code[3]) / 255.0f);
    });
}

float sample_alpha(const ImageLookup& lookup, glm::vec2 uv) {
    return interpolate(
        lookup, uv, [](const std::uint8_t* code) { return static_cast<float>(code[3]) / 255.0f; });
}

}  // namespace opaline::bake
