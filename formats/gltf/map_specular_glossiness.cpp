#include "formats/gltf/map_specular_glossiness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "formats/gltf/clamp_factor.h"
#include "formats/image/srgb.h"

namespace opaline::formats::gltf {

namespace {

constexpr double kDielectric = 0.04;               // F0 of ior 1.5
constexpr std::uint64_t kMostPixels = 1ull << 30;  // of all textures, where one is made of others

struct MetallicRoughness {
    glm::dvec3 base_color;
    double metallic;
};

double brightness(glm::dvec3 c) {
    return std::sqrt(0.299 * c.x * c.x + 0.587 * c.y * c.y + 0.114 * c.z * c.z);
}

/// The metallic factor under which diffuse and specular brightness come out as given: the positive
/// root of a quadratic.
double solve_metallic(double diffuse, double specular, double rest) {
    if (specular < kDielectric) return 0;
    const double b = diffuse * rest / (1 - kDielectric) + specular - 2 * kDielectric;
    const double c = kDielectric - specular;
    const double discriminant = std::max(b * b - 4 * kDielectric * c, 0.0);
    return std::clamp((-b + std::sqrt(discriminant)) / (2 * kDielectric), 0.0, 1.0);
}

MetallicRoughness convert_texel(glm::dvec3 diffuse, glm::dvec3 specular) {
    constexpr double kLeast = 1e-6;
    const double rest = 1 - std::max({specular.x, specular.y, specular.z});
    const double metallic = solve_metallic(brightness(diffuse), brightness(specular), rest);
    const glm::dvec3 of_diffuse =
        diffuse * (rest / (1 - kDielectric) / std::max(1 - metallic, kLeast));
    const glm::dvec3 of_specular =
        (specular - kDielectric * (1 - metallic)) / std::max(metallic, kLeast);
    return {glm::clamp(glm::mix(of_diffuse, of_specular, metallic * metallic), 0.0, 1.0), metallic};
}

std::uint8_t to_code(double value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

/// The texel of an image where `x` of `width` and `y` of `height` are; white without an image.
std::array<std::uint8_t, 4> texel_at(const std::optional<Image8>& image, std::uint32_t x,
                                     std::uint32_t width, std::uint32_t y, std::uint32_t height) {
    if (!image) {
        return {255, 255, 255, 255};
    }
    const std::uint64_t column = std::uint64_t{x} * image->width / width;
    const std::uint64_t row = std::uint64_t{y} * image->height / height;
    const std::uint8_t* code = &image->rgba[4 * (row * image->width + column)];
    return {code[0], code[1], code[2], code[3]};
}

void apply_mean_specular(const Image8& image, double glossiness, Gloss& gloss) {
    const glm::dvec4 mean = mean_texel(image);
    gloss.specular_color = gloss.specular_color * to_rgb(mean);
    gloss.roughness = static_cast<float>(1 - glossiness * mean.w);
}

}  // namespace

MaterialSource as_metallic_roughness(MaterialSource source) {
    if (!source.specular_glossiness) return source;
    const SpecularGlossiness& from = *source.specular_glossiness;
    TranslucencySource& to = source.translucency;
    source.base_color = from.diffuse;
    source.base_color_texture = from.diffuse_texture;
    source.metallic_roughness_texture = {};
    to.metallic = 0;
    to.roughness = 1 - from.glossiness;
    to.states_reflection = true;
    to.has_ior = to.has_specular = true;
    to.ior = 0;  // infinite
    to.specular = 1;
    to.specular_color = from.specular;
    return source;
}

bool add_specular_glossiness(const SpecularGlossiness& source, const std::string& where,
                             TextureLoader& loader, Scene& scene, Material& material,
                             std::vector<std::string>& remarks) {
    const TextureUse& use = source.specular_glossiness_texture;
    const TextureUse& color = source.diffuse_texture;
    if (use.texture == kNone || material.medium || material.gloss.is_diffuse()) return false;
    const auto image = loader.decode(use.texture, where);
    const double glossiness = std::clamp(source.glossiness, 0.0, 1.0);
    if (!image) return false;
    const auto use_mean = [&](const char* remark) {
        remarks.emplace_back(remark);
        apply_mean_specular(*image, glossiness, material.gloss);
        return false;
    };
    if (color.texture != kNone &&
        (color.texcoord != use.texcoord || color.transform != use.transform)) {
        return use_mean(
            "specularGlossinessTexture is mapped otherwise than diffuseTexture: its mean is used "
            "(give both the same texCoord and KHR_texture_transform)");
    }
    const auto diffuse =
        color.texture == kNone ? std::optional<Image8>() : loader.decode(color.texture, where);
    const bool as_diffuse = diffuse && diffuse->rgba.size() > image->rgba.size();
    const std::uint32_t width = as_diffuse ? diffuse->width : image->width;
    const std::uint32_t height = as_diffuse ? diffuse->height : image->height;
    std::uint64_t pixels = std::uint64_t{2} * width * height;
    for (const Image8& other : scene.images) {
        pixels += std::uint64_t{other.width} * other.height;
    }
    if (pixels > kMostPixels) {
        return use_mean(
            "specularGlossinessTexture makes the scene's textures too large: its mean is used "
            "(convert the material to metallic-roughness)");
    }
    const std::array<double, 256> linear = decoded_codes();
    const glm::dvec3 factor(material.base_color.r, material.base_color.g, material.base_color.b);
    const glm::dvec3 specular = glm::clamp(source.specular, 0.0, 1.0);
    Image8 base{width, height, {}}, gloss{width, height, {}};
    base.rgba.reserve(std::size_t{4} * width * height);
    gloss.rgba.reserve(std::size_t{4} * width * height);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const auto d = texel_at(diffuse, x, width, y, height);
            const auto s = texel_at(image, x, width, y, height);
            const MetallicRoughness texel =
                convert_texel(factor * glm::dvec3(linear[d[0]], linear[d[1]], linear[d[2]]),
                              specular * glm::dvec3(linear[s[0]], linear[s[1]], linear[s[2]]));
            for (int band = 0; band < 3; ++band) {
                base.rgba.push_back(to_code(static_cast<double>(
                    srgb_from_linear(static_cast<float>(texel.base_color[band])))));
            }
            base.rgba.push_back(d[3]);
            const std::uint8_t roughness = to_code(1 - glossiness * s[3] / 255.0);
            gloss.rgba.insert(gloss.rgba.end(), {255, roughness, to_code(texel.metallic), 255});
        }
    }
    const LoadedTexture sampler =
        loader.sampler_of(color.texture == kNone ? use.texture : color.texture);
    material.base_color = {1, 1, 1};
    material.base_color_image = static_cast<std::uint32_t>(scene.images.size());
    material.base_color_texcoord = use.texcoord;
    material.base_color_uv_transform = use.transform;
    material.wrap_u = sampler.wrap_u;
    material.wrap_v = sampler.wrap_v;
    material.gloss = {.metallic = 1,
                      .roughness = 1,
                      .specular = 1,
                      .image = material.base_color_image + 1,
                      .wrap_u = sampler.wrap_u,
                      .wrap_v = sampler.wrap_v};
    scene.images.push_back(std::move(base));
    scene.images.push_back(std::move(gloss));
    return true;
}

}  // namespace opaline::formats::gltf
