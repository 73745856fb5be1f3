#include "formats/gltf/read_lights.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/gltf/named_object.h"
#include "formats/gltf/read_texture_use.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

constexpr const char* kLights = "KHR_lights_punctual";
constexpr std::uint64_t kMostLights = 0x7ffffffe;

std::string name_of(const Json& object) {
    const auto name = object.find("name");
    return name != object.end() && name->is_string() ? name->get<std::string>() : std::string();
}

/// A member that is an object; null where it is missing, and, with an error, where it is no object.
const Json* member(const Json& object, const char* key, const std::string& where, Report& report) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return nullptr;
    }
    if (!found->is_object()) {
        report.error(where, std::string(key) + " is not an object", kExportAgain);
        return nullptr;
    }
    return &*found;
}

const Json* extension(const Json& object, const char* name, const std::string& where,
                      Report& report) {
    const Json* extensions = member(object, "extensions", where, report);
    return extensions == nullptr ? nullptr : member(*extensions, name, where, report);
}

void read_type(const NamedObject& light, LightSource& out) {
    const auto found = light.object.find("type");
    const std::string type =
        found != light.object.end() && found->is_string() ? found->get<std::string>() : "";
    if (type == "point") {
        out.type = Light::Type::point;
    } else if (type == "spot") {
        out.type = Light::Type::spot;
    } else if (type == "directional") {
        out.type = Light::Type::directional;
    } else {
        light.report.error(light.where,
                           type.empty() ? "its type is missing" : "its type is " + in_quotes(type),
                           "make it 'point', 'spot' or 'directional'");
    }
}

LightSource read_light(const Json& object, std::size_t index, Report& report) {
    LightSource out;
    out.name = name_of(object);
    const NamedObject light{object, label("light", index, out.name), report};
    read_type(light, out);
    light.color("color", out.color);
    light.number("intensity", out.intensity);
    if (object.contains("range")) {
        light.number("range", out.range.emplace(0.0));
    }
    if (const Json* spot = member(object, "spot", light.where, report)) {
        const NamedObject cone{*spot, light.where + " > spot", report};
        cone.number("innerConeAngle", out.inner_cone);
        cone.number("outerConeAngle", out.outer_cone);
    }
    return out;
}

}  // namespace

std::vector<LightSource> read_lights(const Json& root, Report& report) {
    std::vector<LightSource> lights;
    const Json* found = extension(root, kLights, "", report);
    if (found == nullptr) {
        return lights;
    }
    const auto list = found->find("lights");
    if (list == found->end()) {
        return lights;
    }
    const bool good =
        list->is_array() && std::all_of(list->begin(), list->end(),
                                        [](const Json& entry) { return entry.is_object(); });
    if (!good) {
        report.error(kLights, "lights is not an array of objects", kExportAgain);
        return lights;
    }
    lights.reserve(list->size());
    for (const Json& light : *list) {
        lights.push_back(read_light(light, lights.size(), report));
    }
    return lights;
}

std::vector<std::uint32_t> read_node_lights(const Json& root, Report& report) {
    std::vector<std::uint32_t> lights;
    const auto nodes = root.find("nodes");
    if (nodes == root.end()) {
        return lights;
    }
    lights.assign(nodes->size(), kNone);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Json& node = (*nodes)[i];
        const std::string where = label("node", i, name_of(node));
        const Json* found = extension(node, kLights, where, report);
        if (found == nullptr) {
            continue;
        }
        const auto index = found->find("light");
        if (index == found->end() || !index->is_number_unsigned() ||
            index->get<std::uint64_t>() > kMostLights) {
            report.error(where, std::string(kLights) + ": light is not a small whole number",
                         kExportAgain);
            continue;
        }
        lights[i] = index->get<std::uint32_t>();
    }
    return lights;
}

std::vector<EmissionSource> read_emission(const Json& root, Report& report) {
    std::vector<EmissionSource> sources;
    const auto materials = root.find("materials");
    if (materials == root.end()) {
        return sources;
    }
    sources.reserve(materials->size());
    for (const Json& material : *materials) {
        const std::string where = label("material", sources.size(), name_of(material));
        EmissionSource& out = sources.emplace_back();
        NamedObject{material, where, report}.color("emissiveFactor", out.factor);
        if (const Json* strength =
                extension(material, "KHR_materials_emissive_strength", where, report)) {
            NamedObject{*strength, where + " > KHR_materials_emissive_strength", report}.number(
                "emissiveStrength", out.strength);
        }
        if (const auto texture = material.find("emissiveTexture"); texture != material.end()) {
            out.texture = read_texture_use(*texture, where + " > emissiveTexture", report);
        }
    }
    return sources;
}

}  // namespace opaline::formats::gltf
