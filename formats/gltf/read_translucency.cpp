#include "formats/gltf/read_translucency.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/gltf/read_texture_use.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

/// Reads the members of one extension (or of pbrMetallicRoughness) of one material.
struct Extension {
    const Json& object;
    std::string where;  ///< "material 'Wax' > KHR_materials_volume"
    TranslucencySource& out;
    Report& report;

    void wrong(const char* key, const char* expected) const {
        report.error(where, std::string(key) + " is not " + expected, "export the file again");
    }
    void number(const char* key, double& value) const {
        const auto found = object.find(key);
        if (found == object.end()) {
            return;
        }
        if (!found->is_number()) {
            wrong(key, "a number");
            return;
        }
        value = found->get<double>();
    }
    void color(const char* key, glm::dvec3& value) const {
        const auto found = object.find(key);
        if (found == object.end()) {
            return;
        }
        const bool good = found->is_array() && found->size() == 3 &&
                          std::all_of(found->begin(), found->end(),
                                      [](const Json& band) { return band.is_number(); });
        if (!good) {
            wrong(key, "an array of three numbers");
            return;
        }
        value = {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
    }
    void texture(const char* key, TextureUse& use) const {
        if (const auto found = object.find(key); found != object.end()) {
            use = read_texture_use(*found, where + " > " + key, report);
        }
    }
    void texture(const char* key) const {
        if (object.contains(key)) {
            out.textures.emplace_back(key);
        }
    }
};

/// Calls `read` with the extension if the material has it; returns whether it has.
template <class Read>
bool read_extension(const Json& extensions, const char* name, const std::string& where,
                    TranslucencySource& out, Report& report, const Read& read) {
    const auto found = extensions.find(name);
    if (found == extensions.end()) {
        return false;
    }
    if (!found->is_object()) {
        report.error(where, std::string(name) + " is not an object", "export the file again");
        return false;
    }
    read(Extension{*found, where + " > " + name, out, report});
    return true;
}

void read_scattering(const Json& extensions, const std::string& where, TranslucencySource& out,
                     Report& report) {
    out.has_scatter = read_extension(
        extensions, "KHR_materials_scatter", where, out, report, [&](const Extension& scatter) {
            if (scatter.object.contains("scatterStrengthFactor")) {
                scatter.number("scatterStrengthFactor", out.scatter_strength.emplace(0.0));
            }
            scatter.color("multiscatterColorFactor", out.multiscatter_color);
            scatter.number("scatterAnisotropy", out.anisotropy);
            scatter.texture("scatterStrengthTexture", out.scatter_strength_texture);
            scatter.texture("multiscatterColorTexture", out.multiscatter_color_texture);
        });
    if (out.has_scatter) {
        return;  // a file with both was written for readers of either
    }
    out.has_volume_scatter = read_extension(
        extensions, "KHR_materials_volume_scatter", where, out, report,
        [&](const Extension& scatter) {
            out.multiscatter_color = glm::dvec3(0.0);
            // The draft's revisions differ in the name.
            scatter.color("multiscatterColor", out.multiscatter_color);
            scatter.color("multiscatterColorFactor", out.multiscatter_color);
            scatter.number("scatterAnisotropy", out.anisotropy);
            scatter.texture("multiscatterColorTexture", out.multiscatter_color_texture);
        });
}

void read_surface(const Json& material, const Json& extensions, const std::string& where,
                  TranslucencySource& out, Report& report) {
    read_extension(material, "pbrMetallicRoughness", where, out, report, [&](const Extension& pbr) {
        pbr.number("metallicFactor", out.metallic);
        pbr.number("roughnessFactor", out.roughness);
        pbr.texture("metallicRoughnessTexture");
    });
    out.is_diffuse = extensions.contains("KHR_materials_unlit") ||
                     (extensions.contains("KHR_materials_pbrSpecularGlossiness") &&
                      !material.contains("pbrMetallicRoughness"));
    out.has_ior = read_extension(extensions, "KHR_materials_ior", where, out, report,
                                 [&](const Extension& ior) { ior.number("ior", out.ior); });
    out.has_specular = read_extension(extensions, "KHR_materials_specular", where, out, report,
                                      [&](const Extension& specular) {
                                          specular.number("specularFactor", out.specular);
                                          specular.color("specularColorFactor", out.specular_color);
                                          specular.texture("specularTexture");
                                          specular.texture("specularColorTexture");
                                      });
    out.has_transmission =
        read_extension(extensions, "KHR_materials_transmission", where, out, report,
                       [&](const Extension& transmission) {
                           transmission.number("transmissionFactor", out.transmission);
                           transmission.texture("transmissionTexture");
                       });
    out.has_diffuse_transmission = read_extension(
        extensions, "KHR_materials_diffuse_transmission", where, out, report,
        [&](const Extension& transmission) {
            transmission.number("diffuseTransmissionFactor", out.diffuse_transmission);
            transmission.color("diffuseTransmissionColorFactor", out.diffuse_transmission_color);
            transmission.texture("diffuseTransmissionTexture");
            transmission.texture("diffuseTransmissionColorTexture");
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
            report.error(where, "extensions is not an object", "export the file again");
            continue;
        }
        out.has_volume = read_extension(
            extensions, "KHR_materials_volume", where, out, report, [&](const Extension& volume) {
                volume.number("thicknessFactor", out.thickness);
                volume.number("attenuationDistance", out.attenuation_distance);
                volume.color("attenuationColor", out.attenuation_color);
                volume.texture("thicknessTexture");
            });
        read_scattering(extensions, where, out, report);
        read_surface(material, extensions, where, out, report);
    }
    return sources;
}

}  // namespace opaline::formats::gltf
