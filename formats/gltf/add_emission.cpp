#include "formats/gltf/add_emission.h"

#include "formats/gltf/clamp_factor.h"
#include "formats/gltf/share_coordinates.h"

namespace opaline::formats::gltf {

namespace {

Rgb map_emission(const EmissionSource& source, std::vector<std::string>& remarks) {
    constexpr double kMostStrength = 1e12;  // far above the sun's 1.6e9 nit
    return to_rgb(clamp_color(source.factor, "emissiveFactor", remarks) *
                  clamp_factor(source.strength, 0, kMostStrength, "emissiveStrength", remarks));
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
            material.emission = material.emission * to_rgb(mean_texel(*image));
        }
        return;
    }
    const LoadedTexture loaded = loader.load(use.texture, where);
    material.emission_image = loaded.image;
    material.emission_wrap_u = loaded.wrap_u;
    material.emission_wrap_v = loaded.wrap_v;
}

}  // namespace opaline::formats::gltf
