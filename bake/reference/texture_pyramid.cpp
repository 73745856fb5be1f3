#include "bake/reference/texture_pyramid.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace opaline::bake {
namespace {

using formats::TextureWrap;
using Level = TexturePyramid::Level;

Level decoded(const formats::Image8& image, bool is_linear) {
    Level level{image.width, image.height, {}};
    level.texel.reserve(std::size_t{image.width} * image.height);
    const ImageLookup lookup{image, TextureWrap::clamp, TextureWrap::clamp, is_linear};
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
            level.texel.push_back(sample_image(
                lookup, {(static_cast<float>(x) + 0.5f) / static_cast<float>(image.width),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height)}));
        }
    }
    return level;
}

// Shares of `size` texels that the i-th of `smaller` covers, from `first` on.
struct Shares {
    std::uint32_t first = 0;
    std::vector<float> weight;
};
Shares shares_of(std::uint32_t i, std::uint32_t size, std::uint32_t smaller) {
    const double scale = static_cast<double>(size) / smaller;
    const double begin = i * scale, end = (i + 1) * scale;
    Shares shares;
    shares.first = static_cast<std::uint32_t>(begin);
    shares.weight.reserve(4);  // an odd size has at most 3
    for (std::uint32_t k = shares.first; k < size && static_cast<double>(k) < end - 1e-9; ++k) {
        const double covered = std::min<double>(k + 1, end) - std::max<double>(k, begin);
        shares.weight.push_back(static_cast<float>(covered / scale));
    }
    return shares;
}

std::vector<Shares> all_shares(std::uint32_t size, std::uint32_t smaller) {
    std::vector<Shares> all;
    all.reserve(smaller);
    for (std::uint32_t i = 0; i < smaller; ++i) {
        all.push_back(shares_of(i, size, smaller));
    }
    return all;
}

Level halved(const Level& fine) {
    Level coarse{std::max(1u, fine.width / 2), std::max(1u, fine.height / 2), {}};
    coarse.texel.reserve(std::size_t{coarse.width} * coarse.height);
    const std::vector<Shares> columns = all_shares(fine.width, coarse.width);
    for (const Shares& row : all_shares(fine.height, coarse.height)) {
        for (const Shares& column : columns) {
            glm::vec4 sum(0);
            for (std::size_t j = 0; j < row.weight.size(); ++j) {
                const glm::vec4* texel = &fine.texel[(row.first + j) * fine.width + column.first];
                for (std::size_t i = 0; i < column.weight.size(); ++i) {
                    sum += row.weight[j] * column.weight[i] * texel[i];
                }
            }
            coarse.texel.push_back(sum);
        }
    }
    return coarse;
}

// A coordinate as one in [0, 1] with the same texels.
float folded(float u, TextureWrap mode) {
    constexpr float kLargest = 1e6f;  // as of sample_image
    if (!(std::abs(u) < kLargest)) {
        return 0;
    }
    if (mode == TextureWrap::clamp) {
        return std::clamp(u, 0.0f, 1.0f);
    }
    if (mode == TextureWrap::repeat) {
        return u - std::floor(u);
    }
    const float twice = u - 2 * std::floor(0.5f * u);
    return twice > 1 ? 2 - twice : twice;
}

// Two neighbours along one axis, and the weight of the second.
struct Neighbours {
    std::uint32_t low, high;
    float share;
};
Neighbours neighbours(float u, std::uint32_t size, TextureWrap mode) {
    const float x = u * static_cast<float>(size) - 0.5f, floor = std::floor(x);
    const auto low = static_cast<std::int32_t>(floor);
    const auto last = static_cast<std::int32_t>(size) - 1;
    const bool repeats = mode == TextureWrap::repeat;
    return {static_cast<std::uint32_t>(low >= 0  ? std::min(low, last)
                                       : repeats ? last
                                                 : 0),
            static_cast<std::uint32_t>(low < last ? low + 1
                                       : repeats  ? 0
                                                  : last),
            x - floor};
}

glm::vec4 sample_level(const ImageLookup& lookup, const Level& level, glm::vec2 at) {
    const Neighbours x = neighbours(at.x, level.width, lookup.wrap_u);
    const Neighbours y = neighbours(at.y, level.height, lookup.wrap_v);
    const glm::vec4* low = &level.texel[std::size_t{y.low} * level.width];
    const glm::vec4* high = &level.texel[std::size_t{y.high} * level.width];
    return (1 - y.share) * ((1 - x.share) * low[x.low] + x.share * low[x.high]) +
           y.share * ((1 - x.share) * high[x.low] + x.share * high[x.high]);
}

glm::vec4 sample_any_level(const ImageLookup& lookup, const TexturePyramid& pyramid,
                           std::size_t level, glm::vec2 uv) {
    return level == 0 ? sample_image(lookup, uv)
                      : sample_level(lookup, pyramid.coarser[level - 1],
                                     {folded(uv.x, lookup.wrap_u), folded(uv.y, lookup.wrap_v)});
}

bool is_even(const formats::Image8& image) {
    const std::span<const std::uint8_t> all = image.rgba;
    for (std::size_t i = 4; i < all.size(); ++i) {
        if (all[i] != all[i - 4]) {
            return false;
        }
    }
    return true;
}

}  // namespace

TexturePyramid make_pyramid(const formats::Image8& image, bool is_linear) {
    TexturePyramid pyramid;
    Level fine = decoded(image, is_linear);
    while (fine.width > 1 || fine.height > 1) {
        fine = halved(fine);
        pyramid.coarser.push_back(fine);
    }
    return pyramid;
}

glm::vec4 sample_footprint(const ImageLookup& lookup, const TexturePyramid& pyramid, glm::vec2 uv,
                           const UvMoments& footprint) {
    const auto width = static_cast<float>(lookup.image.width);
    const auto height = static_cast<float>(lookup.image.height);
    // Eigenvalues of the moments in texels: squares of the extents l1 >= l2.
    const float a = footprint.uu * width * width, b = footprint.uv * width * height;
    const float c = footprint.vv * height * height;
    const float middle = 0.5f * (a + c), half = std::sqrt(0.25f * (a - c) * (a - c) + b * b);
    const float major = middle + half;
    if (!(major > 1) || pyramid.coarser.empty() || !std::isfinite(major)) {
        return sample_image(lookup, uv);
    }
    const float minor = std::max((a * c - b * b) / major, 0.0f);
    const float wanted = std::ceil(std::sqrt(major / std::max(minor, 1.0f)));
    const int count = static_cast<int>(std::min(wanted, static_cast<float>(kMostTaps)));
    const float most = static_cast<float>(pyramid.coarser.size());
    const float each = major / static_cast<float>(count * count);
    const float level = std::min(0.5f * std::log2(std::max({minor, each, 1.0f})), most);
    const auto below = static_cast<std::size_t>(level);
    const float share = level - static_cast<float>(below);
    glm::vec2 axis(0);
    if (count > 1) {
        // Of the two forms of the eigenvector the one without cancellation.
        const glm::vec2 e = a > c ? glm::vec2(major - c, b) : glm::vec2(b, major - a);
        axis = std::sqrt(major / glm::dot(e, e)) * e / glm::vec2(width, height);
    }
    glm::vec4 fine(0), coarse(0);
    for (int i = 0; i < count; ++i) {
        const float along = (static_cast<float>(i) + 0.5f) / static_cast<float>(count) - 0.5f;
        const glm::vec2 at = uv + along * axis;
        fine += sample_any_level(lookup, pyramid, below, at);
        if (share > 0) {
            coarse += sample_any_level(lookup, pyramid, below + 1, at);
        }
    }
    return ((1 - share) * fine + share * coarse) / static_cast<float>(count);
}

bool ScenePyramids::any() const {
    const auto filled = [](const TexturePyramid& p) { return !p.coarser.empty(); };
    return std::any_of(color.begin(), color.end(), filled) ||
           std::any_of(data.begin(), data.end(), filled);
}

ScenePyramids make_scene_pyramids(const formats::Scene& scene) {
    ScenePyramids pyramids;
    pyramids.color.resize(scene.images.size());
    pyramids.data.resize(scene.images.size());
    const auto add = [&](std::uint32_t image, bool is_linear) {
        if (image == formats::kNone || is_even(scene.images[image])) {
            return;
        }
        TexturePyramid& to = (is_linear ? pyramids.data : pyramids.color)[image];
        if (to.coarser.empty()) {
            to = make_pyramid(scene.images[image], is_linear);
        }
    };
    for (const formats::Material& material : scene.materials) {
        add(material.base_color_image, false);
        add(material.emission_image, false);
        add(material.gloss.image, true);
    }
    return pyramids;
}

bool has_pyramid(const ScenePyramids& pyramids, const formats::Material& material) {
    const auto in = [](const std::vector<TexturePyramid>& all, std::uint32_t image) {
        return image != formats::kNone && !all[image].coarser.empty();
    };
    return in(pyramids.color, material.base_color_image) ||
           in(pyramids.color, material.emission_image) || in(pyramids.data, material.gloss.image);
}

}  // namespace opaline::bake
