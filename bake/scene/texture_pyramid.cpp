#include "bake/scene/texture_pyramid.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace opaline::bake {
namespace {

using formats::TextureWrap;
using Level = TexturePyramid::Level;

// A texel of the image itself, linear.
glm::vec4 decoded(const ImageLookup& lookup, std::uint32_t x, std::uint32_t y) {
    const glm::vec2 size(lookup.image.width, lookup.image.height);
    return sample_image(lookup, (glm::vec2(x, y) + 0.5f) / size);
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

// `texel`: of the finer level, by column and row.
template <class Texel>
Level halved(std::uint32_t width, std::uint32_t height, const Texel& texel) {
    Level coarse{std::max(1u, width / 2), std::max(1u, height / 2), {}};
    coarse.texel.reserve(std::size_t{coarse.width} * coarse.height);
    const std::vector<Shares> columns = all_shares(width, coarse.width);
    for (const Shares& row : all_shares(height, coarse.height)) {
        for (const Shares& column : columns) {
            glm::vec4 sum(0);
            for (std::uint32_t j = 0; j < row.weight.size(); ++j) {
                for (std::uint32_t i = 0; i < column.weight.size(); ++i) {
                    sum +=
                        row.weight[j] * column.weight[i] * texel(column.first + i, row.first + j);
                }
            }
            coarse.texel.push_back(sum);
        }
    }
    return coarse;
}

// A coordinate as one in [0, 1] with the same texels.
float folded(float u, TextureWrap mode) {
    mode = formats::edge_of(mode);
    constexpr float kLargest = 1e6f;  // as of sample_image
    if (!(std::abs(u) < kLargest)) return 0;
    if (mode == TextureWrap::clamp) return std::clamp(u, 0.0f, 1.0f);
    if (mode == TextureWrap::repeat) return u - std::floor(u);
    const float twice = u - 2 * std::floor(0.5f * u);
    return twice > 1 ? 2 - twice : twice;
}

// Two neighbours along one axis, and the weight of the second.
struct TexelPair {
    std::uint32_t low, high;
    float share;
};
TexelPair neighbours(float u, std::uint32_t size, TextureWrap mode) {
    const float x = u * static_cast<float>(size) - 0.5f, floor = std::floor(x);
    const auto low = static_cast<std::int32_t>(floor);
    const auto last = static_cast<std::int32_t>(size) - 1;
    const bool repeats = formats::edge_of(mode) == TextureWrap::repeat;
    return {static_cast<std::uint32_t>(low >= 0  ? std::min(low, last)
                                       : repeats ? last
                                                 : 0),
            static_cast<std::uint32_t>(low < last ? low + 1
                                       : repeats  ? 0
                                                  : last),
            x - floor};
}

glm::vec4 sample_level(const ImageLookup& lookup, const Level& level, glm::vec2 at) {
    const TexelPair x = neighbours(at.x, level.width, lookup.wrap_u);
    const TexelPair y = neighbours(at.y, level.height, lookup.wrap_v);
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

}  // namespace

glm::dmat3x2 uv_gradient(const formats::Primitive& primitive, std::uint32_t first_index) {
    if (primitive.texcoord.empty()) return glm::dmat3x2(0.0);
    const std::uint32_t* const i = &primitive.index[first_index];
    const glm::dvec3 origin(primitive.position[i[0]]);
    const glm::dvec3 s = glm::dvec3(primitive.position[i[1]]) - origin;
    const glm::dvec3 t = glm::dvec3(primitive.position[i[2]]) - origin;
    const glm::dvec3 n = glm::cross(s, t);
    const double square = glm::dot(n, n);
    if (!(square > 1e-24 * glm::dot(s, s) * glm::dot(t, t))) return glm::dmat3x2(0.0);
    // Gradients of the weights of the second and third corner.
    const glm::dvec3 along_s = glm::cross(t, n) / square, along_t = glm::cross(n, s) / square;
    const glm::dvec2 uv(primitive.texcoord[i[0]]);
    const glm::dvec2 ds = glm::dvec2(primitive.texcoord[i[1]]) - uv;
    const glm::dvec2 dt = glm::dvec2(primitive.texcoord[i[2]]) - uv;
    return glm::outerProduct(ds, along_s) + glm::outerProduct(dt, along_t);
}

UvMoments moments_of_area(const glm::dmat3x2& duv_dP, double area) {
    const glm::dmat2 squares = area * (duv_dP * glm::transpose(duv_dP));
    return {squares[0][0], squares[0][1], squares[1][1]};
}

UvMoments moments_of_edges(const glm::dmat3x2& duv_dP, const glm::dvec3& a, const glm::dvec3& b) {
    UvMoments moments;
    moments.add(duv_dP * a);
    moments.add(duv_dP * b);
    return moments;
}

UvMoments moments_of_cone(const glm::dmat3x2& duv_dP, const glm::dvec3& direction,
                          const glm::dvec3& normal, double distance, double solid_angle) {
    constexpr double kLeastCosine = 1e-4;
    const double width = distance * std::sqrt(solid_angle);
    const double cosine = glm::dot(direction, normal);
    const glm::dvec3 across = glm::cross(direction, normal);
    const double sine = glm::length(across);
    if (!(sine > 1e-6)) return moments_of_area(duv_dP, width * width);
    // Across the plane of incidence as wide as the cone, along it 1 / cosine longer.
    const glm::dvec3 along = (direction - cosine * normal) / sine;
    return moments_of_edges(duv_dP, width / sine * across,
                            width / std::max(std::abs(cosine), kLeastCosine) * along);
}

UvMoments moments_of_triangle(const std::array<glm::dvec2, 3>& uv) {
    const glm::dvec2 middle = (uv[0] + uv[1] + uv[2]) / 3.0;
    UvMoments moments;  // 12 times 1/12 of the squares of the corners' offsets
    for (const glm::dvec2& corner : uv) {
        moments.add(corner - middle);
    }
    return moments;
}

bool is_even(const formats::Image8& image) {
    const std::span<const std::uint8_t> all = image.rgba;
    for (std::size_t i = 4; i < all.size(); ++i) {
        if (all[i] != all[i - 4]) return false;
    }
    return true;
}

TexturePyramid make_pyramid(const formats::Image8& image, bool is_linear) {
    TexturePyramid pyramid;
    const ImageLookup lookup{image, TextureWrap::clamp, TextureWrap::clamp, is_linear};
    const auto of_image = [&](std::uint32_t x, std::uint32_t y) { return decoded(lookup, x, y); };
    if (image.width > 1 || image.height > 1) {
        pyramid.coarser.push_back(halved(image.width, image.height, of_image));
    }
    while (!pyramid.coarser.empty() &&
           (pyramid.coarser.back().width > 1 || pyramid.coarser.back().height > 1)) {
        const Level& fine = pyramid.coarser.back();
        pyramid.coarser.push_back(
            halved(fine.width, fine.height, [&](std::uint32_t x, std::uint32_t y) {
                return fine.texel[std::size_t{y} * fine.width + x];
            }));
    }
    return pyramid;
}

glm::vec4 sample_footprint(const ImageLookup& lookup, const TexturePyramid& pyramid, glm::vec2 uv,
                           const UvMoments& footprint) {
    if (pyramid.coarser.empty()) return sample_image(lookup, uv);
    const TextureTaps taps =
        texture_taps(footprint, {lookup.image.width, lookup.image.height}, kMostTaps);
    if (!(taps.major > 1)) return sample_image(lookup, uv);
    const auto most = static_cast<float>(pyramid.coarser.size());
    const float level = std::min(static_cast<float>(taps.level), most);
    const auto below = static_cast<std::size_t>(level);
    const float share = level - static_cast<float>(below);
    glm::vec4 fine(0), coarse(0);
    for (int i = 0; i < taps.count; ++i) {
        const glm::vec2 at = taps.count > 1 ? uv + glm::vec2(taps.offset(i)) : uv;
        fine += sample_any_level(lookup, pyramid, below, at);
        if (share > 0) {
            coarse += sample_any_level(lookup, pyramid, below + 1, at);
        }
    }
    return ((1 - share) * fine + share * coarse) / static_cast<float>(taps.count);
}

glm::vec4 sample_over(const ImageLookup& lookup, std::uint32_t number, glm::vec2 uv,
                      const TextureView* view) {
    if (view == nullptr) return sample_image(lookup, uv);
    const auto& all = lookup.is_linear ? view->pyramids.data : view->pyramids.color;
    return number < all.size() ? sample_footprint(lookup, all[number], uv, view->moments)
                               : sample_image(lookup, uv);
}

bool ScenePyramids::any() const {
    const auto filled = [](const TexturePyramid& p) { return !p.coarser.empty(); };
    return std::any_of(color.begin(), color.end(), filled) ||
           std::any_of(data.begin(), data.end(), filled);
}

ScenePyramids make_scene_pyramids(const formats::Scene& scene,
                                  std::span<const std::uint8_t> of_material) {
    ScenePyramids pyramids;
    pyramids.color.resize(scene.images.size());
    pyramids.data.resize(scene.images.size());
    const auto add = [&](std::uint32_t image, bool is_linear) {
        if (image == formats::kNone || is_even(scene.images[image])) return;
        TexturePyramid& to = (is_linear ? pyramids.data : pyramids.color)[image];
        if (to.coarser.empty()) {
            to = make_pyramid(scene.images[image], is_linear);
        }
    };
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        if (!of_material.empty() && of_material[m] == 0) continue;
        const formats::Material& material = scene.materials[m];
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
