#include "formats/gltf/map_gloss.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "formats/gltf/clamp_factor.h"

namespace opaline::formats::gltf {

namespace {

using Remarks = std::vector<std::string>;

float unit_factor(double value, const char* name, Remarks& remarks) {
    if (value >= 0.0 && value <= 1.0) return static_cast<float>(value);
    remarks.push_back(std::string(name) + " is outside [0, 1] and is clamped");
    return value > 1.0 ? 1.0f : 0.0f;
}

/// Large enough for any use; keeps F0, a product with ((ior - 1)/(ior + 1))^2 <= 1, finite.
constexpr double kMaxSpecularColor = 1e6, kMaxIor = 1e6;

Rgb specular_color(glm::dvec3 color, Remarks& remarks) {
    const glm::dvec3 inside = glm::clamp(color, 0.0, kMaxSpecularColor);
    if (inside != color) {
        remarks.push_back("specularColorFactor is out of its range and is clamped");
    }
    return to_rgb(inside);
}

float index_of_refraction(double ior, Remarks& remarks) {
    if (ior == 0.0) return 0.0f;
    if (!(ior >= 1.0)) {
        remarks.push_back("ior is below 1 and is taken as 1");
        return 1.0f;
    }
    return static_cast<float>(std::min(ior, kMaxIor));
}

}  // namespace

Gloss map_gloss(const TranslucencySource& source, Remarks& remarks) {
    Gloss gloss;
    if (source.is_diffuse) return gloss;
    gloss.metallic = unit_factor(source.metallic, "metallicFactor", remarks);
    gloss.roughness = unit_factor(source.roughness, "roughnessFactor", remarks);
    gloss.specular = unit_factor(source.specular, "specularFactor", remarks);
    gloss.specular_color = specular_color(source.specular_color, remarks);
    gloss.ior = index_of_refraction(source.ior, remarks);
    for (const std::string& texture : source.textures) {
        if (texture == "specularTexture" || texture == "specularColorTexture") {
            remarks.push_back(texture + " is not read: the factor is used alone");
        }
    }
    return gloss;
}

void apply_mean(const Image8& metallic_roughness, Gloss& gloss) {
    std::uint64_t roughness = 0, metallic = 0;
    for (std::size_t i = 0; i + 3 < metallic_roughness.rgba.size(); i += 4) {
        roughness += metallic_roughness.rgba[i + 1];
        metallic += metallic_roughness.rgba[i + 2];
    }
    const double all = 255.0 * static_cast<double>(metallic_roughness.rgba.size() / 4);
    gloss.roughness *= static_cast<float>(static_cast<double>(roughness) / all);
    gloss.metallic *= static_cast<float>(static_cast<double>(metallic) / all);
}

}  // namespace opaline::formats::gltf
