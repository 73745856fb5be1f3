#include "formats/gltf/read_translucency.h"

#include <nlohmann/json.hpp>

#include "formats/gltf/named_object.h"
#include "formats/gltf/read_texture_use.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

// Each reads a member of an extension, or of pbrMetallicRoughness, that is a texture.
void read_texture(const NamedObject& extension, const char* key, TextureUse& use) {
    if (const auto found = extension.object.find(key); found != extension.object.end()) {
        use = read_texture_use(*found, extension.where + " > " + key, extension.report);
    }
}

void note_texture(const NamedObject& extension, const char* key, TranslucencySource& out) {
    if (extension.object.contains(key)) {
        out.textures.emplace_back(key);
    }
}

/// Calls `read` with the extension if the material has it; returns whether it has.
template <class Read>
bool read_extension(const Json& extensions, const char* name, const std::string& where,
                    Report& report, const Read& read) {
    const auto found = extensions.find(name);
    if (found == extensions.end()) {
        return false;
    }
    if (!found->is_object()) {
        report.error(where, std::string(name) + " is not an object", kExportAgain);
        return false;
    }
    read(NamedObject{*found, where + " > " + name, report});
    return true;
}

void read_scattering(const Json& extensions, const std::string& where, TranslucencySource& out,
                     Report& report) {
    out.has_scatter = read_extension(
        extensions, "KHR_materials_scatter", where, report, [&](const NamedObject& scatter) {
            if (scatter.object.contains("scatterStrengthFactor")) {
                scatter.number("scatterStrengthFactor", out.scatter_strength.emplace(0.0));
            }
            scatter.color("multiscatterColorFactor", out.multiscatter_color);
            scatter.number("scatterAnisotropy", out.anisotropy);
            read_texture(scatter, "scatterStrengthTexture", out.scatter_strength_texture);
            read_texture(scatter, "multiscatterColorTexture", out.multiscatter_color_texture);
        });
    if (out.has_scatter) {
        return;  // a file with both was written for readers of either
    }
    out.has_volume_scatter = read_extension(
        extensions, "KHR_materials_volume_scatter", where, report, [&](const NamedObject& scatter) {
            out.multiscatter_color = glm::dvec3(0.0);
            // The draft's revisions differ in the name.
            scatter.color("multiscatterColor", out.multiscatter_color);
            scatter.color("multiscatterColorFactor", out.multiscatter_color);
            scatter.number("scatterAnisotropy", out.anisotropy);
            read_texture(scatter, "multiscatterColorTexture", out.multiscatter_color_texture);
        });
}

void read_surface(const Json& material, const Json& extensions, const std::string& where,
                  TranslucencySource& out, Report& report) {
    read_extension(material, "pbrMetallicRoughness", where, report, [&](const NamedObject& pbr) {
        pbr.number("metallicFactor", out.metallic);
        pbr.number("roughnessFactor", out.roughness);
        note_texture(pbr, "metallicRoughnessTexture", out);
        out.states_reflection = pbr.object.contains("metallicFactor") ||
                                pbr.object.contains("roughnessFactor") ||
                                pbr.object.contains("metallicRoughnessTexture");
    });
    out.is_diffuse = extensions.contains("KHR_materials_unlit");
    out.has_ior = read_extension(extensions, "KHR_materials_ior", where, report,
                                 [&](const NamedObject& ior) { ior.number("ior", out.ior); });
    out.has_specular = read_extension(extensions, "KHR_materials_specular", where, report,
                                      [&](const NamedObject& specular) {
                                          specular.number("specularFactor", out.specular);
                                          specular.color("specularColorFactor", out.specular_color);
                                          note_texture(specular, "specularTexture", out);
                                          note_texture(specular, "specularColorTexture", out);
                                      });
    out.has_transmission =
        read_extension(extensions, "KHR_materials_transmission", where, report,
                       [&](const NamedObject& transmission) {
                           transmission.number("transmissionFactor", out.transmission);
                           note_texture(transmission, "transmissionTexture", out);
                       });
    out.has_diffuse_transmission = read_extension(
        extensions, "KHR_materials_diffuse_transmission", where, report,
        [&](const NamedObject& transmission) {
            transmission.number("diffuseTransmissionFactor", out.diffuse_transmission);
            transmission.color("diffuseTransmissionColorFactor", out.diffuse_transmission_color);
            note_texture(transmission, "diffuseTransmissionTexture", out);
            note_texture(transmission, "diffuseTransmissionColorTexture", out);
        });
}

}  // namespace

std::vector<TranslucencySource> read_translucency(const Json& root, Report& report) {
    std::vector<TranslucencySource> sources;
    const auto materials = root.find("materials");
    if (materials == root.end()) {
        return sources;
    }
    for (const Json& material : *materials) {
        TranslucencySource& out = sources.emplace_back();
        const auto name = material.find("name");
        const std::string where =
            label("material", sources.size() - 1,
                  name != material.end() && name->is_string() ? name->get<std::string>() : "");
        const Json extensions = material.value("extensions", Json::object());
        if (!extensions.is_object()) {
            report.error(where, "extensions is not an object", kExportAgain);
            continue;
        }
        out.has_volume = read_extension(
            extensions, "KHR_materials_volume", where, report, [&](const NamedObject& volume) {
                volume.number("thicknessFactor", out.thickness);
                volume.number("attenuationDistance", out.attenuation_distance);
                volume.color("attenuationColor", out.attenuation_color);
                note_texture(volume, "thicknessTexture", out);
            });
        read_scattering(extensions, where, out, report);
        read_surface(material, extensions, where, out, report);
    }
    return sources;
}

}  // namespace opaline::formats::gltf
