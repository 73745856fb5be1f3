#include "formats/gltf/share_coordinates.h"

namespace opaline::formats::gltf {

bool share_coordinates(const MaterialSource& source, const TextureUse& use, Material& material) {
    const bool is_mapped = source.base_color_texture.texture != kNone ||
                           material.gloss.image != kNone || material.emission_image != kNone ||
                           (material.medium && material.medium->variation);
    if (!is_mapped) {
        material.base_color_texcoord = use.texcoord;
        material.base_color_uv_transform = use.transform;
    }
    return use.texcoord == material.base_color_texcoord &&
           use.transform == material.base_color_uv_transform;
}

}  // namespace opaline::formats::gltf
