#include "formats/gltf/add_emission.h"

#include <algorithm>
#include <array>

#include "formats/gltf/clamp_factor.h"
#include "formats/gltf/share_coordinates.h"
#include "formats/image/srgb.h"

namespace opaline::formats::gltf {

namespace {

/// Linear mean of a texture's colours.
glm::dvec3 mean_color(const Image8& image) {
    std::array<double, 256> linear{};
    for (std::size_t code = 0; code < linear.size(); ++code) {
        linear[code] = static_cast<double>(linear_from_srgb(static_cast<float>(code) / 255.0f));
    }
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        sum +=
            glm::dvec3(linear[image.rgba[i]], linear[image.rgba[i + 1]], linear[image.rgba[i + 2]]);
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, image.rgba.size() / 4));
}

Rgb map_emission(const EmissionSource& source, std::vector<std::string>& remarks) {
    constexpr double kMostStrength = 1e12;  // far above the sun's 1.6e9 nit
    const glm::vec3 emission(
        clamp_color(source.factor, "emissiveFactor", remarks) *
        clamp_factor(source.strength, 0, kMostStrength, "emissiveStrength", remarks));
    return {emission.x, emission.y, emission.z};
}

}  // namespace

void add_emission(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                  Material& material, std::vector<std::string>& remarks) {
    material.emission = map_emission(source.emission, remarks);
    const TextureUse& use = source.emission.texture;
    if (use.texture == kNone || material.emission == Rgb{0, 0, 0}) {
        return;
    }
    if (!share_coordinates(source, use, material)) {
        remarks.emplace_back(
            "emissiveTexture is mapped otherwise than the material's other textures: its mean is "
            "used (give all the same texCoord and KHR_texture_transform)");
        if (const auto image = loader.decode(use.texture, where)) {
            const glm::vec3 mean(mean_color(*image));
            material.emission = material.emission * Rgb{mean.x, mean.y, mean.z};
        }
        return;
    }
    const LoadedTexture loaded = loader.load(use.texture, where);
    material.emission_image = loaded.image;
    material.emission_wrap_u = loaded.wrap_u;
    material.emission_wrap_v = loaded.wrap_v;
}

}  // namespace opaline::formats::gltf
