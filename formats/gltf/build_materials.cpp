#include "formats/gltf/build_materials.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "formats/gltf/decode_image8.h"
#include "formats/gltf/map_medium.h"

namespace opaline::formats::gltf {

namespace {

/// The meaning of an extension that is not simulated.
std::string unsimulated_extension(const std::string& name) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 17> kKnown = {{
        {"KHR_materials_volume", "absorption inside the object"},
        {"KHR_materials_scatter", "scattering inside the object"},
        {"KHR_materials_volume_scatter", "scattering inside the object"},
        {"KHR_materials_diffuse_transmission", "diffuse transmission"},
        {"KHR_materials_transmission", "transmission"},
        {"KHR_materials_ior", "the index of refraction"},
        {"KHR_materials_specular", "specular reflection"},
        {"KHR_materials_emissive_strength", "emission"},
        {"KHR_materials_clearcoat", "clear coat"},
        {"KHR_materials_sheen", "sheen"},
        {"KHR_materials_iridescence", "iridescence"},
        {"KHR_materials_anisotropy", "anisotropic reflection"},
        {"KHR_materials_dispersion", "dispersion"},
        {"KHR_materials_unlit", "unlit shading; it is baked as a lit diffuse surface"},
        {"KHR_materials_pbrSpecularGlossiness", "specular-glossiness shading"},
        {"KHR_materials_variants", "material variants"},
        {"KHR_texture_basisu", "Basis Universal textures"},
    }};
    for (const auto& [known, meaning] : kKnown) {
        if (name == known) {
            return name + " is not simulated: " + std::string(meaning);
        }
    }
    return "extension " + in_quotes(name) + " is not simulated";
}

/// The extensions that a medium stands for.
bool is_part_of_medium(std::string_view name) {
    constexpr std::array<std::string_view, 7> kParts = {
        "KHR_materials_volume",         "KHR_materials_scatter",
        "KHR_materials_volume_scatter", "KHR_materials_diffuse_transmission",
        "KHR_materials_transmission",   "KHR_materials_ior",
        "KHR_materials_specular"};
    return std::find(kParts.begin(), kParts.end(), name) != kParts.end();
}

std::vector<std::string> unsimulated(const MaterialSource& material, bool has_medium) {
    std::vector<std::string> faults;
    for (const std::string& name : material.extensions) {
        if (!has_medium || !is_part_of_medium(name)) {
            faults.push_back(unsimulated_extension(name));
        }
    }
    if (material.alpha_mode != "OPAQUE") {
        faults.push_back("alphaMode " + in_quotes(material.alpha_mode) +
                         " is not simulated: the surface is baked opaque");
    }
    if (material.emissive != glm::dvec3(0.0)) {
        faults.push_back("emissiveFactor is not simulated: the surface sends out no light");
    }
    if (material.metallic > 0.0) {
        faults.push_back(
            std::string("metallicFactor above 0 is not simulated: the surface is baked ") +
            (has_medium ? "as a dielectric" : "diffuse"));
    }
    if (material.has_normal_map) {
        faults.push_back("normalTexture is not simulated: vertex normals are used alone");
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

Material::Wrap wrap_mode(std::uint32_t value, const std::string& where, Report& report) {
    switch (value) {
        case 10497:
            return Material::Wrap::repeat;
        case 33071:
            return Material::Wrap::clamp;
        case 33648:
            return Material::Wrap::mirror;
        default:
            report.error(
                where, "wrap mode " + std::to_string(value) + " is none of 10497, 33071 and 33648",
                "export the file again");
            return Material::Wrap::repeat;
    }
}

/// The decoded image as an index into scene.images; `known` holds those already decoded.
std::uint32_t load_image(const Document& document, std::uint32_t index, Resources& resources,
                         std::map<std::uint32_t, std::uint32_t>& known, Scene& scene,
                         Report& report) {
    if (const auto found = known.find(index); found != known.end()) {
        return found->second;
    }
    known[index] = kNone;
    const ImageSource& source = document.images[index];
    const std::string where = label("image", index, source.name);
    Bytes bytes;
    if (source.uri.empty()) {
        const BufferView& view = document.views[source.view];
        bytes = resources.buffers[view.buffer].subspan(view.offset, view.length);
    } else if (const auto read = read_uri(resources, source.uri, where, report)) {
        bytes = *read;
    } else {
        return kNone;
    }
    DecodedImage8 decoded = decode_image8(bytes);
    if (!decoded.fault.empty()) {
        report.error(where, decoded.fault, "save the texture again as 8-bit PNG or JPEG");
        return kNone;
    }
    known[index] = static_cast<std::uint32_t>(scene.images.size());
    scene.images.push_back(std::move(decoded.image));
    return known[index];
}

float unit_factor(double value, bool& clamped) {
    clamped = clamped || !(value >= 0.0 && value <= 1.0);
    return static_cast<float>(value > 0.0 ? std::min(value, 1.0) : 0.0);
}

Material convert(const MaterialSource& source, const std::string& where, Report& report) {
    Material material;
    material.name = source.name;
    bool clamped = false;
    material.base_color = {unit_factor(source.base_color.x, clamped),
                           unit_factor(source.base_color.y, clamped),
                           unit_factor(source.base_color.z, clamped)};
    if (clamped) {
        report.warn(where, "baseColorFactor was outside [0, 1] and is clamped",
                    "a surface cannot reflect more light than it receives");
    }
    material.double_sided = source.double_sided;
    return material;
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
    std::map<std::uint32_t, std::uint32_t> images;
    std::map<std::string, std::vector<std::string>> lost;
    for (std::size_t i = 0; i < document.materials.size(); ++i) {
        const MaterialSource& source = document.materials[i];
        const std::string where = label("material", i, source.name);
        Material material = convert(source, where, report);
        const TextureUse& use = source.base_color_texture;
        std::vector<std::string> remarks;
        material.medium = map_medium(source.translucency, metres_per_unit, remarks);
        if (used[i]) {
            for (const std::string& fault : unsimulated(source, material.medium.has_value())) {
                lost[fault].push_back(where);
            }
            for (const std::string& remark : remarks) {
                lost[remark].push_back(where);
            }
        }
        if (used[i] && use.texture != kNone) {
            const Texture& texture = document.textures[use.texture];
            if (texture.image == kNone) {
                report.error(where,
                             "texture " + std::to_string(use.texture) + " has no PNG or JPEG image",
                             "export the texture as PNG or JPEG");
            } else {
                material.base_color_image =
                    load_image(document, texture.image, resources, images, scene, report);
            }
            material.base_color_texcoord = use.texcoord;
            material.base_color_uv_transform = use.transform;
            if (texture.sampler != kNone) {
                const Sampler& sampler = document.samplers[texture.sampler];
                const std::string at = "sampler " + std::to_string(texture.sampler);
                material.wrap_u = wrap_mode(sampler.wrap_s, at, report);
                material.wrap_v = wrap_mode(sampler.wrap_t, at, report);
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
