#include "formats/gltf/build_materials.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "formats/gltf/add_textures.h"
#include "formats/gltf/clamp_factor.h"
#include "formats/gltf/document.h"
#include "formats/gltf/load_texture.h"
#include "formats/gltf/map_gloss.h"
#include "formats/gltf/map_medium.h"
#include "formats/gltf/map_sheet.h"
#include "formats/gltf/map_specular_glossiness.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {
namespace {

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
