#include "formats/gltf/read_lights.h"

#include <nlohmann/json.hpp>
#include <string>

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

constexpr const char* kPunctual = "KHR_lights_punctual";
constexpr std::uint64_t kMostLights = 0x7ffffffe;

void read_type(const NamedObject& light, LightSource& out) {
    const std::string type = name_in(light.object, "type");
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
    out.name = name_in(object);
    const NamedObject light{object, label("light", index, out.name), report};
    read_type(light, out);
    light.color("color", out.color);
    light.number("intensity", out.intensity);
    if (object.contains("range")) {
        light.number("range", out.range.emplace(0.0));
    }
    if (const auto spot = light.member("spot")) {
        spot->number("innerConeAngle", out.inner_cone);
        spot->number("outerConeAngle", out.outer_cone);
    }
    return out;
}

}  // namespace

std::vector<LightSource> read_lights(const Json& root, Report& report) {
    std::vector<LightSource> lights;
    const auto found = NamedObject{root, "", report}.extensions().member(kPunctual);
    const Json* list = found ? find_member(found->object, "lights") : nullptr;
    if (!list) return lights;
    if (!is_array_of(*list, &Json::is_object)) {
        report.error(found->where, "lights is not an array of objects");
        return lights;
    }
    lights.reserve(list->size());
    for (const Json& light : *list) {
        lights.push_back(read_light(light, lights.size(), report));
    }
    return lights;
}

std::uint32_t read_node_light(const NamedObject& node) {
    const auto found = node.extensions().member(kPunctual);
    if (!found) return kNone;
    const auto index = whole_in(found->object, "light", kMostLights);
    if (!index) {
        node.report.error(node.where,
                          std::string(kPunctual) + ": light is not a small whole number");
    }
    return index ? static_cast<std::uint32_t>(*index) : kNone;
}

}  // namespace opaline::formats::gltf
