#include "formats/gltf/map_sheet.h"

#include <algorithm>

#include "formats/gltf/clamp_factor.h"

namespace opaline::formats::gltf {

namespace {

// Light that leaves on the side where it came from, and on the other one.
struct Sides {
    glm::dvec3 reflected, transmitted;
};

bool scatters_no_light(glm::dvec3 color) {
    return !(std::max({color.x, color.y, color.z}) > 0.0);
}

std::optional<Sides> scatter(const TranslucencySource& source, glm::dvec3 base,
                             std::vector<std::string>& remarks) {
    const bool scatters = source.has_volume_scatter ||
                          (source.has_scatter && source.scatter_strength.value_or(0.0) > 0.0);
    if (!scatters || !(source.transmission > 0.0) || scatters_no_light(source.multiscatter_color)) {
        return std::nullopt;
    }
    const double strength = source.has_scatter ? clamp_factor(*source.scatter_strength, 0.0, 1.0,
                                                              "scatterStrengthFactor", remarks)
                                               : 1.0;
    const double let_in =
        clamp_factor(source.transmission, 0.0, 1.0, "transmissionFactor", remarks);
    const double g = clamp_factor(source.anisotropy, -1.0, 1.0, "scatterAnisotropy", remarks);
    const glm::dvec3 scattered =
        let_in * strength * base *
        clamp_color(source.multiscatter_color, "the multiscatter colour", remarks);
    if (strength < 1.0) {
        remarks.push_back(
            "scatterStrengthFactor below 1 lets light through unscattered, which is not simulated");
    }
    return Sides{(1.0 - let_in) * base + 0.5 * (1.0 - g) * scattered, 0.5 * (1.0 + g) * scattered};
}

std::optional<Sides> transmit_diffusely(const TranslucencySource& source, glm::dvec3 base,
                                        bool has_base_color_texture,
                                        std::vector<std::string>& remarks) {
    const bool scatters = source.has_scatter && source.scatter_strength.value_or(0.0) > 0.0;
    if (!(source.diffuse_transmission > 0.0) || scatters) {
        return std::nullopt;
    }
    const double f =
        clamp_factor(source.diffuse_transmission, 0.0, 1.0, "diffuseTransmissionFactor", remarks);
    if (has_base_color_texture) {
        remarks.push_back("baseColorTexture colours diffusely transmitted light as well");
    }
    const double clear = clamp_factor(source.transmission, 0.0, 1.0, "transmissionFactor", remarks);
    if (clear > 0.0) {
        remarks.push_back(
            "what KHR_materials_transmission lets through is not simulated: the "
            "diffuse part is baked alone");
    }
    return Sides{(1.0 - clear) * (1.0 - f) * base,
                 (1.0 - clear) * f *
                     clamp_color(source.diffuse_transmission_color,
                                 "diffuseTransmissionColorFactor", remarks)};
}

}  // namespace

std::optional<MappedSheet> map_sheet(const TranslucencySource& source, Rgb base_color,
                                     bool has_base_color_texture,
                                     std::vector<std::string>& remarks) {
    if (source.has_volume && source.thickness > 0.0) {
        return std::nullopt;
    }
    const glm::dvec3 base{base_color.r, base_color.g, base_color.b};
    auto sides = scatter(source, base, remarks);
    if (!sides) {
        sides = transmit_diffusely(source, base, has_base_color_texture, remarks);
    }
    if (!sides) {
        return std::nullopt;
    }
    std::vector<std::string> textures = source.textures;
    if (source.scatter_strength_texture.texture != kNone) {
        textures.emplace_back("scatterStrengthTexture");
    }
    if (source.multiscatter_color_texture.texture != kNone) {
        textures.emplace_back("multiscatterColorTexture");
    }
    for (const std::string& texture : textures) {
        remarks.push_back(texture + " is not simulated: the factor is used alone");
    }
    if (source.metallic > 0.0) {
        remarks.push_back(
            "a metallicFactor above 0 of a thin-walled surface mirrors in the larger "
            "of the colours that it reflects and transmits");
    }
    const glm::dvec3 larger = glm::max(sides->reflected, sides->transmitted);
    const auto share = [&](glm::dvec3 part) {
        const glm::dvec3 s = part / glm::max(larger, glm::dvec3(1e-30));
        return Rgb{static_cast<float>(s.x), static_cast<float>(s.y), static_cast<float>(s.z)};
    };
    return MappedSheet{
        {static_cast<float>(larger.x), static_cast<float>(larger.y), static_cast<float>(larger.z)},
        {share(sides->reflected), share(sides->transmitted)}};
}

}  // namespace opaline::formats::gltf
