#include "formats/gltf/read_material.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kMostTextures = 0x7fffffff, kMostTexcoords = 255;

/// A whole number up to `most`; absent: `otherwise`. Nothing where it is something else.
std::optional<std::uint32_t> whole(const Json& object, const char* key, std::uint32_t most,
                                   std::uint32_t otherwise) {
    if (!object.contains(key)) return otherwise;
    const auto found = whole_in(object, key, most);
    return found ? std::optional(static_cast<std::uint32_t>(*found)) : std::nullopt;
}

std::optional<double> number(const Json& object, const char* key) {
    const Json* found = find_member(object, key);
    if (!found) return 0.0;
    return found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::optional<glm::dvec2> pair(const Json& object, const char* key, glm::dvec2 otherwise) {
    const Json* found = find_member(object, key);
    if (!found) return otherwise;
    return is_array_of(*found, &Json::is_number, 2)
               ? std::optional(glm::dvec2((*found)[0].get<double>(), (*found)[1].get<double>()))
               : std::nullopt;
}

/// KHR_texture_transform: translation * rotation * scale. Its example (offset 0 1, rotation pi/2,
/// scale 1/2 is the lower left quadrant) holds for a rotation that is counter-clockwise with v
/// pointing down, so sin enters with the opposite sign of a v-up plane.
glm::mat3 texture_transform(glm::dvec2 offset, double rotation, glm::dvec2 scale) {
    const double cosine = std::cos(rotation), sine = std::sin(rotation);
    return glm::mat3(glm::dmat3(cosine * scale.x, -sine * scale.x, 0.0,  //
                                sine * scale.y, cosine * scale.y, 0.0,   //
                                offset.x, offset.y, 1.0));
}

TextureUse read_texture_use(const Json& info, const std::string& where, Report& report) {
    if (!info.is_object()) {
        report.error(where, "it is not an object");
        return {};
    }
    const auto index = whole(info, "index", kMostTextures, kNone);
    const auto texcoord = whole(info, "texCoord", kMostTexcoords, 0);
    if (!index || *index == kNone || !texcoord) {
        report.error(where, "index or texCoord is not a small whole number");
        return {};
    }
    TextureUse use{*index, *texcoord};
    const Json* transform = find_extension(info, "KHR_texture_transform");
    if (!transform) return use;
    if (!transform->is_object()) {
        report.error(where, "its KHR_texture_transform is not an object");
        return {};
    }
    const auto offset = pair(*transform, "offset", glm::dvec2(0.0));
    const auto scale = pair(*transform, "scale", glm::dvec2(1.0));
    const auto rotation = number(*transform, "rotation");
    const auto own = whole(*transform, "texCoord", kMostTexcoords, use.texcoord);
    if (!offset || !scale || !rotation || !own) {
        report.error(where, "its KHR_texture_transform has a member of the wrong type");
        return {};
    }
    use.texcoord = *own;
    use.transform = texture_transform(*offset, *rotation, *scale);
    return use;
}

void read_texture(const NamedObject& object, const char* key, TextureUse& use) {
    if (const Json* found = find_member(object.object, key)) {
        use = read_texture_use(*found, object.where + " > " + key, object.report);
    }
}

// A member of an extension, or of pbrMetallicRoughness, that is a texture and not read.
void note_texture(const NamedObject& extension, const char* key, TranslucencySource& out) {
    if (extension.object.contains(key)) {
        out.textures.emplace_back(key);
    }
}

void read_scattering(const NamedObject& extensions, TranslucencySource& out) {
    auto scatter = extensions.member("KHR_materials_scatter");
    out.has_scatter = scatter.has_value();
    if (scatter) {
        if (scatter->object.contains("scatterStrengthFactor")) {
            scatter->number("scatterStrengthFactor", out.scatter_strength.emplace(0.0));
        }
        read_texture(*scatter, "scatterStrengthTexture", out.scatter_strength_texture);
    } else if (const auto draft = extensions.member("KHR_materials_volume_scatter")) {
        out.has_volume_scatter = true;  // a file with both was written for readers of either
        out.multiscatter_color = glm::dvec3(0.0);
        draft->color("multiscatterColor", out.multiscatter_color);  // revisions differ in the name
        scatter.emplace(*draft);
    } else {
        return;
    }
    scatter->color("multiscatterColorFactor", out.multiscatter_color);
    scatter->number("scatterAnisotropy", out.anisotropy);
    read_texture(*scatter, "multiscatterColorTexture", out.multiscatter_color_texture);
}

void read_reflection(const NamedObject& pbr, TranslucencySource& out) {
    pbr.number("metallicFactor", out.metallic);
    pbr.number("roughnessFactor", out.roughness);
    note_texture(pbr, "metallicRoughnessTexture", out);
    out.states_reflection = pbr.object.contains("metallicFactor") ||
                            pbr.object.contains("roughnessFactor") ||
                            pbr.object.contains("metallicRoughnessTexture");
}

void read_translucency(const NamedObject& extensions, TranslucencySource& out) {
    if (const auto volume = extensions.member("KHR_materials_volume")) {
        out.has_volume = true;
        volume->number("thicknessFactor", out.thickness);
        volume->number("attenuationDistance", out.attenuation_distance);
        volume->color("attenuationColor", out.attenuation_color);
        note_texture(*volume, "thicknessTexture", out);
    }
    read_scattering(extensions, out);
    out.is_diffuse = extensions.object.contains("KHR_materials_unlit");
    if (const auto ior = extensions.member("KHR_materials_ior")) {
        out.has_ior = true;
        ior->number("ior", out.ior);
    }
    if (const auto specular = extensions.member("KHR_materials_specular")) {
        out.has_specular = true;
        specular->number("specularFactor", out.specular);
        specular->color("specularColorFactor", out.specular_color);
        note_texture(*specular, "specularTexture", out);
        note_texture(*specular, "specularColorTexture", out);
    }
    if (const auto transmission = extensions.member("KHR_materials_transmission")) {
        out.has_transmission = true;
        transmission->number("transmissionFactor", out.transmission);
        note_texture(*transmission, "transmissionTexture", out);
    }
    if (const auto diffuse = extensions.member("KHR_materials_diffuse_transmission")) {
        out.has_diffuse_transmission = true;
        diffuse->number("diffuseTransmissionFactor", out.diffuse_transmission);
        diffuse->color("diffuseTransmissionColorFactor", out.diffuse_transmission_color);
        note_texture(*diffuse, "diffuseTransmissionTexture", out);
        note_texture(*diffuse, "diffuseTransmissionColorTexture", out);
    }
}

SpecularGlossiness read_specular_glossiness(const NamedObject& object) {
    SpecularGlossiness out;
    object.color("diffuseFactor", out.diffuse);
    object.color("specularFactor", out.specular);
    object.number("glossinessFactor", out.glossiness);
    read_texture(object, "diffuseTexture", out.diffuse_texture);
    read_texture(object, "specularGlossinessTexture", out.specular_glossiness_texture);
    return out;
}

}  // namespace

MaterialSource read_material(const NamedObject& material) {
    MaterialSource out;
    out.name = name_in(material.object);
    const NamedObject extensions = material.extensions();
    out.extensions = extensions.keys();
    read_translucency(extensions, out.translucency);
    if (const auto pbr = material.member("pbrMetallicRoughness")) {
        pbr->color("baseColorFactor", out.base_color);
        read_texture(*pbr, "baseColorTexture", out.base_color_texture);
        read_texture(*pbr, "metallicRoughnessTexture", out.metallic_roughness_texture);
        read_reflection(*pbr, out.translucency);
    }
    if (const auto object = extensions.member("KHR_materials_pbrSpecularGlossiness")) {
        out.specular_glossiness = read_specular_glossiness(*object);
    }
    material.color("emissiveFactor", out.emission.factor);
    if (const auto strength = extensions.member("KHR_materials_emissive_strength")) {
        strength->number("emissiveStrength", out.emission.strength);
    }
    read_texture(material, "emissiveTexture", out.emission.texture);
    read_texture(material, "normalTexture", out.normal_texture);
    if (const auto normal = material.member("normalTexture")) {
        normal->number("scale", out.normal_scale);
    }
    out.has_occlusion_map = material.object.contains("occlusionTexture");
    const auto* double_sided = find_member(material.object, "doubleSided");
    out.double_sided = double_sided && *double_sided == true;
    const std::string alpha_mode = name_in(material.object, "alphaMode");
    out.alpha_mode = alpha_mode.empty() ? "OPAQUE" : alpha_mode;
    material.number("alphaCutoff", out.alpha_cutoff);
    return out;
}

}  // namespace opaline::formats::gltf
