#include "formats/gltf/map_sheet.h"

#include <algorithm>
#include <cmath>

#include "formats/gltf/clamp_factor.h"
#include "formats/opal/thin_glass.h"

namespace opaline::formats::gltf {

namespace {

// Light that leaves on the side where it came from, and on the other one; and the share of what
// enters that passes without being scattered, as thin glass lets it.
struct Sides {
    glm::dvec3 reflected, transmitted;
    double clear = 0;
};

std::optional<Sides> scatter(const TranslucencySource& source, glm::dvec3 base,
                             std::vector<std::string>& remarks) {
    const bool scatters = source.has_volume_scatter ||
                          (source.has_scatter && source.scatter_strength.value_or(0.0) > 0.0);
    if (!scatters || !(source.transmission > 0.0) || is_black(source.multiscatter_color)) {
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
    return Sides{(1.0 - let_in) * base + 0.5 * (1.0 - g) * scattered, 0.5 * (1.0 + g) * scattered,
                 let_in * (1.0 - strength)};
}

std::optional<Sides> transmit_diffusely(const TranslucencySource& source, glm::dvec3 base,
                                        bool has_base_color_texture,
                                        std::vector<std::string>& remarks) {
    const bool scatters = source.has_scatter && source.scatter_strength.value_or(0.0) > 0.0;
    if (!(source.diffuse_transmission > 0.0) || scatters) return std::nullopt;
    const double f =
        clamp_factor(source.diffuse_transmission, 0.0, 1.0, "diffuseTransmissionFactor", remarks);
    if (has_base_color_texture) {
        remarks.push_back("baseColorTexture colours diffusely transmitted light as well");
    }
    const double clear = clamp_factor(source.transmission, 0.0, 1.0, "transmissionFactor", remarks);
    return Sides{(1.0 - clear) * (1.0 - f) * base,
                 (1.0 - clear) * f *
                     clamp_color(source.diffuse_transmission_color,
                                 "diffuseTransmissionColorFactor", remarks),
                 clear};
}

std::optional<Sides> transmit_straight(const TranslucencySource& source, glm::dvec3 base,
                                       std::vector<std::string>& remarks) {
    if (!(source.transmission > 0.0)) return std::nullopt;
    const double clear = clamp_factor(source.transmission, 0.0, 1.0, "transmissionFactor", remarks);
    return Sides{(1.0 - clear) * base, glm::dvec3(0), clear};
}

// Means over even light, with the cosine: what one smooth face lets through, and what two do.
struct EvenTransmittance {
    double face = 0, pane = 0;
};
EvenTransmittance even_transmittance(float eta) {
    constexpr int kSteps = 256;
    EvenTransmittance mean;
    for (int i = 0; i < kSteps; ++i) {
        const double cosine = (i + 0.5) / kSteps;
        const double pane =
            static_cast<double>(thin_glass_transmittance(static_cast<float>(cosine), eta));
        mean.pane += 2 * cosine / kSteps * pane;
        mean.face += 2 * cosine / kSteps * 2 * pane / (1 + pane);  // T = (1 - R) / (1 + R)
    }
    return mean;
}

// The index of refraction of a dielectric that reflects that share along its normal.
float index_of(double reflectance) {
    const double root = std::sqrt(reflectance);
    return root < 0.999 ? static_cast<float>((1 + root) / (1 - root)) : 0.0f;
}

// Splits what passes unscattered. Of a smooth surface of perceptual roughness r, (1 - r)^2 goes
// straight; the rest leaves diffusely on the other side. Rays meet the surface with the share
// 1 - clear T, and it is then that the rest counts: sides and gloss are divided by that share. The
// faces mirror before anything else, two of them where light passes.
void make_glass(const TranslucencySource& source, glm::dvec3 base, Sides& sides, MappedSheet& to,
                std::vector<std::string>& remarks) {
    const double metallic = std::clamp(source.metallic, 0.0, 1.0);
    const double roughness = std::clamp(source.roughness, 0.0, 1.0);
    const double smooth = (1 - roughness) * (1 - roughness) * sides.clear;
    const double straight = (1 - metallic) * smooth;
    sides.transmitted += (sides.clear - smooth) * base;
    const double passes = straight * static_cast<double>(luminance(to_rgb(base)));
    const double ior = source.ior == 0.0 ? 0.0 : std::max(source.ior, 1.0);
    to.sheet.eta = static_cast<float>(std::min(ior, 1e4));
    to.sheet.clear = static_cast<float>(passes);
    const EvenTransmittance even = even_transmittance(to.sheet.eta);
    const double mirrored = 1 - (1 - straight) * even.face - straight * even.pane;
    const double met = 1 - passes * even.pane;
    const double scale = met - mirrored > 1e-4 ? (1 - mirrored) / (met - mirrored) : 0.0;
    sides.reflected *= scale;
    sides.transmitted *= scale;
    const double root = (ior - 1) / (ior + 1), face = root * root;  // along the normal
    const double pane = (1 - face) / (1 + face);
    to.mirror_ior = index_of(
        std::min(1.0, (1 - (1 - straight) * (1 - face) - straight * pane) / (1 - passes * pane)));
    if (straight > 0 && (base.x != base.y || base.y != base.z)) {
        remarks.push_back(
            "the colour of thin glass dims what passes it straight by its luminance alone: what is "
            "seen and lit through it is not coloured");
    }
}

}  // namespace

std::optional<MappedSheet> map_sheet(const TranslucencySource& source, Rgb base_color,
                                     bool has_base_color_texture,
                                     std::vector<std::string>& remarks) {
    if (source.has_volume && source.thickness > 0.0) return std::nullopt;
    const glm::dvec3 base{base_color.r, base_color.g, base_color.b};
    auto sides = scatter(source, base, remarks);
    if (!sides) {
        sides = transmit_diffusely(source, base, has_base_color_texture, remarks);
    }
    if (!sides) {
        sides = transmit_straight(source, base, remarks);
    }
    if (!sides) return std::nullopt;
    MappedSheet mapped;
    if (sides->clear > 0) {
        make_glass(source, base, *sides, mapped, remarks);
        if (has_base_color_texture) {
            remarks.push_back("baseColorTexture does not tint what passes thin glass straight");
        }
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
        return to_rgb(part / glm::max(larger, glm::dvec3(1e-30)));
    };
    mapped.base_color = to_rgb(larger);
    mapped.sheet.reflect = share(sides->reflected);
    mapped.sheet.transmit = share(sides->transmitted);
    return mapped;
}

}  // namespace opaline::formats::gltf
