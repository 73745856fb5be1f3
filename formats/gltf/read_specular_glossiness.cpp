#include "formats/gltf/read_specular_glossiness.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/gltf/named_object.h"
#include "formats/gltf/read_texture_use.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

constexpr const char* kName = "KHR_materials_pbrSpecularGlossiness";

void read_diffuse(const NamedObject& object, glm::dvec4& diffuse) {
    const auto found = object.object.find("diffuseFactor");
    if (found == object.object.end()) {
        return;
    }
    const bool good = found->is_array() && found->size() == 4 &&
                      std::all_of(found->begin(), found->end(),
                                  [](const Json& value) { return value.is_number(); });
    if (!good) {
        object.report.error(object.where, "diffuseFactor is not an array of four numbers",
                            kExportAgain);
        return;
    }
    diffuse = {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>(),
               (*found)[3].get<double>()};
}

}  // namespace

std::vector<std::optional<SpecularGlossiness>> read_specular_glossiness(const Json& root,
                                                                        Report& report) {
    std::vector<std::optional<SpecularGlossiness>> all;
    const auto materials = root.find("materials");
    if (materials == root.end()) {
        return all;
    }
    for (const Json& material : *materials) {
        auto& out = all.emplace_back();
        const auto extensions = material.find("extensions");
        if (extensions == material.end() || !extensions->is_object() ||
            !extensions->contains(kName)) {
            continue;
        }
        const std::string where = "material " + std::to_string(all.size() - 1) + " > " + kName;
        if (!(*extensions)[kName].is_object()) {
            report.error(where, "it is not an object", kExportAgain);
            continue;
        }
        const NamedObject object{(*extensions)[kName], where, report};
        out.emplace();
        read_diffuse(object, out->diffuse);
        object.color("specularFactor", out->specular);
        object.number("glossinessFactor", out->glossiness);
        const auto texture = [&](const char* key, TextureUse& use) {
            if (const auto found = object.object.find(key); found != object.object.end()) {
                use = read_texture_use(*found, where + " > " + key, report);
            }
        };
        texture("diffuseTexture", out->diffuse_texture);
        texture("specularGlossinessTexture", out->specular_glossiness_texture);
    }
    return all;
}

}  // namespace opaline::formats::gltf
