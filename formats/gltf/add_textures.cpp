#include "formats/gltf/add_textures.h"

#include "formats/gltf/clamp_factor.h"
#include "formats/gltf/map_gloss.h"

namespace opaline::formats::gltf {

namespace {

/// What is read of a material, and what it is put into.
struct Textured {
    const MaterialSource& source;
    const std::string& where;
    TextureLoader& loader;
    Material& material;
    std::vector<std::string>& remarks;

    void load(const TextureUse& use, std::uint32_t& image, TextureWrap& wrap_u,
              TextureWrap& wrap_v) const {
        const LoadedTexture loaded = loader.load(use.texture, where);
        image = loaded.image;
        wrap_u = loaded.wrap_u;
        wrap_v = loaded.wrap_v;
    }
    void set_coordinates(const TextureUse& use) const {
        material.base_color_texcoord = use.texcoord;
        material.base_color_uv_transform = use.transform;
    }
    bool has_coordinates(const TextureUse& use) const {
        return use.texcoord == material.base_color_texcoord &&
               use.transform == material.base_color_uv_transform;
    }
    /// Whether a texture has the coordinates of those that the material has already; if it has none
    /// yet, it takes this one's.
    bool shares_coordinates(const TextureUse& use) const {
        const bool is_mapped = source.base_color_texture.texture != kNone ||
                               material.gloss.image != kNone || material.emission_image != kNone ||
                               (material.medium && material.medium->variation);
        if (!is_mapped) set_coordinates(use);
        return has_coordinates(use);
    }
};

void add_base_color(const Textured& to) {
    const TextureUse& use = to.source.base_color_texture;
    if (use.texture == kNone) return;
    Material& material = to.material;
    to.load(use, material.base_color_image, material.wrap_u, material.wrap_v);
    to.set_coordinates(use);
}

void add_gloss(const Textured& to) {
    const TextureUse& use = to.source.metallic_roughness_texture;
    Gloss& gloss = to.material.gloss;
    if (use.texture == kNone || to.material.medium || gloss.is_diffuse()) return;
    if (to.shares_coordinates(use)) {
        to.load(use, gloss.image, gloss.wrap_u, gloss.wrap_v);
        return;
    }
    to.remarks.emplace_back(
        "metallicRoughnessTexture is mapped otherwise than baseColorTexture: its mean is used "
        "(give both the same texCoord and KHR_texture_transform)");
    if (const auto image = to.loader.decode(use.texture, to.where)) {
        apply_mean(*image, gloss);
    }
}

/// Scatter textures make a medium vary inside.
void add_scattering(const Textured& to) {
    const TranslucencySource& inside = to.source.translucency;
    bool is_mapped = to.source.base_color_texture.texture != kNone;
    const auto add = [&](const TextureUse& use, const char* name, InnerTexture& texture) {
        if (use.texture == kNone) return;
        if (!is_mapped) {
            to.set_coordinates(use);
            is_mapped = true;
        } else if (!to.has_coordinates(use)) {
            to.remarks.push_back(
                std::string(name) +
                " is mapped otherwise than the material's other textures: the factor is used alone "
                "(give all the same texCoord and KHR_texture_transform)");
            return;
        }
        const LoadedTexture loaded = to.loader.load_inner(use.texture, to.where);
        texture = {loaded.image, loaded.wrap_u, loaded.wrap_v};
    };
    Variation variation;
    add(inside.multiscatter_color_texture, "multiscatterColorTexture", variation.color);
    add(inside.scatter_strength_texture, "scatterStrengthTexture", variation.strength);
    if (variation.color.image != kNone || variation.strength.image != kNone) {
        // Of the predecessor, the albedo is that of g = 0 (map_medium.h).
        variation.g = inside.has_scatter ? to.material.medium->phase.g : 0.0f;
        to.material.medium->variation = variation;
    }
}

void add_emission(const Textured& to) {
    constexpr double kMostStrength = 1e12;  // far above the sun's 1.6e9 nit
    const EmissionSource& source = to.source.emission;
    Material& material = to.material;
    material.emission =
        to_rgb(clamp_color(source.factor, "emissiveFactor", to.remarks) *
               clamp_factor(source.strength, 0, kMostStrength, "emissiveStrength", to.remarks));
    const TextureUse& use = source.texture;
    if (use.texture == kNone || material.emission == Rgb{0, 0, 0}) return;
    if (to.shares_coordinates(use)) {
        to.load(use, material.emission_image, material.emission_wrap_u, material.emission_wrap_v);
        return;
    }
    to.remarks.emplace_back(
        "emissiveTexture is mapped otherwise than the material's other textures: its mean is used "
        "(give all the same texCoord and KHR_texture_transform)");
    if (const auto image = to.loader.decode(use.texture, to.where)) {
        material.emission = material.emission * to_rgb(mean_texel(*image));
    }
}

void add_normal_map(const Textured& to) {
    constexpr double kMostScale = 1e3;  // far steeper than any surface
    const TextureUse& use = to.source.normal_texture;
    Material& material = to.material;
    if (use.texture == kNone) return;
    if (!to.shares_coordinates(use)) {
        to.remarks.emplace_back(
            "normalTexture is mapped otherwise than the material's other textures: it is not used "
            "(give all the same texCoord and KHR_texture_transform)");
        return;
    }
    to.load(use, material.normal_image, material.normal_wrap_u, material.normal_wrap_v);
    material.normal_scale = static_cast<float>(clamp_factor(
        to.source.normal_scale, -kMostScale, kMostScale, "the scale of normalTexture", to.remarks));
}

}  // namespace

void add_textures(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                  Material& material, std::vector<std::string>& remarks) {
    const Textured to{source, where, loader, material, remarks};
    add_base_color(to);
    add_gloss(to);
    if (material.medium) add_scattering(to);
    add_emission(to);
    add_normal_map(to);
}

}  // namespace opaline::formats::gltf
