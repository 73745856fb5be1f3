#include "formats/gltf/add_normal_map.h"

#include "formats/gltf/clamp_factor.h"
#include "formats/gltf/share_coordinates.h"

namespace opaline::formats::gltf {

void add_normal_map(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                    Material& material, std::vector<std::string>& remarks) {
    constexpr double kMostScale = 1e3;  // far steeper than any surface
    const TextureUse& use = source.normal_texture;
    if (use.texture == kNone) {
        return;
    }
    if (!share_coordinates(source, use, material)) {
        remarks.emplace_back(
            "normalTexture is mapped otherwise than the material's other textures: it is not used "
            "(give all the same texCoord and KHR_texture_transform)");
        return;
    }
    const LoadedTexture loaded = loader.load(use.texture, where);
    material.normal_image = loaded.image;
    material.normal_wrap_u = loaded.wrap_u;
    material.normal_wrap_v = loaded.wrap_v;
    material.normal_scale = static_cast<float>(clamp_factor(
        source.normal_scale, -kMostScale, kMostScale, "the scale of normalTexture", remarks));
}

}  // namespace opaline::formats::gltf
