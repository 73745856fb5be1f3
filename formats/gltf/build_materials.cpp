#include "formats/gltf/build_materials.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "formats/gltf/add_emission.h"
#include "formats/gltf/clamp_factor.h"
#include "formats/gltf/document.h"
#include "formats/gltf/load_texture.h"
#include "formats/gltf/map_gloss.h"
#include "formats/gltf/map_medium.h"
#include "formats/gltf/map_sheet.h"
#include "formats/gltf/map_specular_glossiness.h"
#include "formats/gltf/share_coordinates.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {
namespace {

// Material::normal_image with its scale: `normalTexture`. Comes after the material's other
// textures, which decide on its coordinates: one that is mapped otherwise is left out. `remarks`
// gets one sentence for each property that differs from the file; `where` names the material.
void add_normal_map(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                    Material& material, std::vector<std::string>& remarks) {
    constexpr double kMostScale = 1e3;  // far steeper than any surface
    const TextureUse& use = source.normal_texture;
    if (use.texture == kNone) return;
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

/// The meaning of an extension that is not simulated.
std::string unsimulated_extension(const std::string& name) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kKnown = {{
        {"KHR_materials_volume", "absorption inside the object"},
        {"KHR_materials_scatter", "scattering inside the object"},
        {"KHR_materials_volume_scatter", "scattering inside the object"},
        {"KHR_materials_diffuse_transmission", "diffuse transmission"},
        {"KHR_materials_transmission", "transmission"},
        {"KHR_materials_clearcoat", "clear coat"},
        {"KHR_materials_sheen", "sheen"},
        {"KHR_materials_iridescence", "iridescence"},
        {"KHR_materials_anisotropy", "anisotropic reflection"},
        {"KHR_materials_dispersion", "dispersion"},
        {"KHR_materials_unlit", "unlit shading; it is baked as a lit diffuse surface"},
        {"KHR_materials_variants", "material variants"},
        {"KHR_texture_basisu", "Basis Universal textures"},
    }};
    for (const auto& [known, meaning] : kKnown) {
        if (name == known) return name + " is not simulated: " + std::string(meaning);
    }
    return "extension " + in_quotes(name) + " is not simulated";
}

/// The extensions that a medium or a thin-walled surface stands for.
bool is_part_of_medium(std::string_view name) {
    constexpr std::array<std::string_view, 5> kParts = {
        "KHR_materials_volume", "KHR_materials_scatter", "KHR_materials_volume_scatter",
        "KHR_materials_diffuse_transmission", "KHR_materials_transmission"};
    return std::find(kParts.begin(), kParts.end(), name) != kParts.end();
}

/// The extensions that describe a surface's reflection, of a medium or opaque, or its emission.
bool is_part_of_surface(std::string_view name) {
    return name == "KHR_materials_ior" || name == "KHR_materials_specular" ||
           name == "KHR_materials_emissive_strength" ||
           name == "KHR_materials_pbrSpecularGlossiness";
}

std::vector<std::string> unsimulated(const MaterialSource& material, const Material& mapped) {
    std::vector<std::string> faults;
    const bool has_medium = mapped.medium.has_value();
    for (const std::string& name : material.extensions) {
        if (!is_part_of_surface(name) &&
            !((has_medium || mapped.sheet) && is_part_of_medium(name))) {
            faults.push_back(unsimulated_extension(name));
        }
    }
    if (has_medium && material.translucency.metallic > 0.0) {
        faults.push_back(
            "metallicFactor above 0 is not simulated: the surface is baked as a dielectric");
    }
    if (material.has_occlusion_map) {
        faults.push_back("occlusionTexture is not used: occlusion is computed");
    }
    return faults;
}

std::string joined(const std::vector<std::string>& names) {
    constexpr std::size_t kShown = 4;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
        text += (i == 0 ? "" : ", ") + names[i];
    }
    return names.size() > kShown ? text + " and " + std::to_string(names.size() - kShown) + " more"
                                 : text;
}

Material convert(const MaterialSource& source, const std::string& where, Report& report) {
    Material material;
    material.name = source.name;
    const glm::dvec3 color(source.base_color), inside = glm::clamp(color, 0.0, 1.0);
    material.base_color = to_rgb(inside);
    if (inside != color) {
        report.warn(where, "baseColorFactor was outside [0, 1] and is clamped",
                    "a surface cannot reflect more light than it receives");
    }
    material.double_sided = source.double_sided;
    return material;
}

/// Both textures of a material; a primitive has one set of coordinates for them, the base colour's.
void add_textures(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                  Material& material, std::vector<std::string>& remarks) {
    const TextureUse& color = source.base_color_texture;
    if (color.texture != kNone) {
        const LoadedTexture loaded = loader.load(color.texture, where);
        material.base_color_image = loaded.image;
        material.base_color_texcoord = color.texcoord;
        material.base_color_uv_transform = color.transform;
        material.wrap_u = loaded.wrap_u;
        material.wrap_v = loaded.wrap_v;
    }
    const TextureUse& gloss = source.metallic_roughness_texture;
    if (gloss.texture == kNone || material.medium || material.gloss.is_diffuse()) return;
    if (color.texture == kNone) {
        material.base_color_texcoord = gloss.texcoord;
        material.base_color_uv_transform = gloss.transform;
    } else if (gloss.texcoord != color.texcoord || gloss.transform != color.transform) {
        remarks.push_back(
            "metallicRoughnessTexture is mapped otherwise than baseColorTexture: its mean "
            "is used (give both the same texCoord and KHR_texture_transform)");
        if (const auto image = loader.decode(gloss.texture, where)) {
            apply_mean(*image, material.gloss);
        }
        return;
    }
    const LoadedTexture loaded = loader.load(gloss.texture, where);
    material.gloss.image = loaded.image;
    material.gloss.wrap_u = loaded.wrap_u;
    material.gloss.wrap_v = loaded.wrap_v;
}

/// Scatter textures make a medium vary inside; they share the material's coordinates.
void add_scatter_textures(const MaterialSource& source, const std::string& where,
                          TextureLoader& loader, Material& material,
                          std::vector<std::string>& remarks) {
    const TranslucencySource& inside = source.translucency;
    bool is_mapped = source.base_color_texture.texture != kNone;
    const auto add = [&](const TextureUse& use, const char* name, InnerTexture& to) {
        if (use.texture == kNone) return;
        if (!is_mapped) {
            material.base_color_texcoord = use.texcoord;
            material.base_color_uv_transform = use.transform;
            is_mapped = true;
        } else if (use.texcoord != material.base_color_texcoord ||
                   use.transform != material.base_color_uv_transform) {
            remarks.push_back(std::string(name) +
                              " is mapped otherwise than the material's other textures: the factor "
                              "is used alone (give all the same texCoord and "
                              "KHR_texture_transform)");
            return;
        }
        const LoadedTexture loaded = loader.load_inner(use.texture, where);
        to = {loaded.image, loaded.wrap_u, loaded.wrap_v};
    };
    Variation variation;
    add(inside.multiscatter_color_texture, "multiscatterColorTexture", variation.color);
    add(inside.scatter_strength_texture, "scatterStrengthTexture", variation.strength);
    if (variation.color.image != kNone || variation.strength.image != kNone) {
        // Of the predecessor, the albedo is that of g = 0 (map_medium.h).
        variation.g = inside.has_scatter ? material.medium->phase.g : 0.0f;
        material.medium->variation = variation;
    }
}

void add_coverage(const MaterialSource& source, Material& material,
                  std::vector<std::string>& remarks) {
    if (source.alpha_mode == "OPAQUE") return;
    const bool is_mask = source.alpha_mode == "MASK";
    if (!is_mask && source.alpha_mode != "BLEND") {
        remarks.push_back("alphaMode " + in_quotes(source.alpha_mode) +
                          " is not one of glTF: the surface is baked opaque");
        return;
    }
    if (material.medium) {
        remarks.push_back("alphaMode " + in_quotes(source.alpha_mode) +
                          " is not simulated of a medium: its boundary is closed");
        return;
    }
    material.alpha_mode = is_mask ? Material::AlphaMode::mask : Material::AlphaMode::blend;
    material.alpha = static_cast<float>(
        clamp_factor(source.base_color.w, 0, 1, "the alpha of baseColorFactor", remarks));
    if (is_mask) {
        constexpr double kMostCutoff = 1e6;  // from just above 1 on all is cut out
        material.alpha_cutoff = static_cast<float>(
            clamp_factor(source.alpha_cutoff, 0, kMostCutoff, "alphaCutoff", remarks));
    }
}

}  // namespace

void build_materials(const Document& document, const std::vector<MeshInstance>& instances,
                     double metres_per_unit, Resources& resources, Scene& scene, Report& report) {
    std::vector<bool> used(document.materials.size(), false);
    bool needs_default = document.materials.empty();
    for (const MeshInstance& instance : instances) {
        for (const MeshPrimitive& primitive :
             document.meshes[document.nodes[instance.node].mesh].primitives) {
            if (primitive.material == kNone) {
                needs_default = true;
            } else {
                used[primitive.material] = true;
            }
        }
    }
    TextureLoader loader(document, resources, scene, report);
    std::map<std::string, std::vector<std::string>> lost;
    for (std::size_t i = 0; i < document.materials.size(); ++i) {
        MaterialSource source = as_metallic_roughness(document.materials[i]);
        const std::string where = label("material", i, source.name);
        Material material = convert(source, where, report);
        std::vector<std::string> remarks;
        std::optional<float> mirror_ior;
        if (const auto thin = map_sheet(source.translucency, material.base_color,
                                        source.base_color_texture.texture != kNone, remarks)) {
            material.sheet = thin->sheet;
            material.sheet->opaque_color = material.base_color;
            material.sheet->opaque_double_sided = material.double_sided;
            material.base_color = thin->base_color;
            mirror_ior = thin->mirror_ior;
            material.double_sided = true;  // it has two sides
        } else {
            material.medium = map_medium(source.translucency, metres_per_unit, remarks);
        }
        if (!material.medium) {
            material.gloss = map_gloss(source.translucency, remarks);
        }
        if (material.sheet) {
            material.sheet->opaque_metallic = material.gloss.metallic;
            material.gloss.ior = mirror_ior.value_or(material.gloss.ior);
        }
        if (used[i]) {
            if (source.specular_glossiness &&
                add_specular_glossiness(*source.specular_glossiness, where, loader, scene, material,
                                        remarks)) {
                source.base_color_texture = {};
            }
            material.is_unstated_metal =
                !source.translucency.states_reflection && !source.translucency.is_diffuse;
            add_textures(source, where, loader, material, remarks);
            if (material.medium) {
                add_scatter_textures(source, where, loader, material, remarks);
            }
            add_emission(source, where, loader, material, remarks);
            add_normal_map(source, where, loader, material, remarks);
            add_coverage(source, material, remarks);
            for (const std::string& fault : unsimulated(source, material)) {
                lost[fault].push_back(where);
            }
            for (const std::string& remark : remarks) {
                lost[remark].push_back(where);
            }
        }
        scene.materials.push_back(std::move(material));
    }
    if (needs_default) {
        scene.materials.emplace_back().name = "default";
    }
    for (const auto& [fault, materials] : lost) {
        report.warn(joined(materials), fault);
    }
}

}  // namespace opaline::formats::gltf
