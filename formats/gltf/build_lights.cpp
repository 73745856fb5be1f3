#include "formats/gltf/build_lights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "formats/gltf/clamp_factor.h"

namespace opaline::formats::gltf {

namespace {

/// Of intensities [cd, lx] and strengths [nit]: far above the sun's 1.6e9 nit, and products of many
/// remain finite floats.
constexpr double kMostIntensity = 1e12;

/// Names that are unique, each the wanted one where it is free.
class UniqueNames {
  public:
    std::string take(const std::string& wanted) {
        std::string name = wanted;
        std::uint64_t& next = next_[wanted];
        while (!taken_.insert(name).second) {
            next = std::max<std::uint64_t>(next + 1, 2);
            name = wanted + " " + std::to_string(next);
        }
        return name;
    }

  private:
    std::set<std::string> taken_;
    std::map<std::string, std::uint64_t> next_;
};

/// What depends on the file's light alone; warns of values out of their ranges.
Light convert(const LightSource& source, std::size_t index, double metres_per_unit,
              Report& report) {
    std::vector<std::string> remarks;
    Light light;
    light.type = source.type;
    light.intensity =
        to_rgb(clamp_color(source.color, "color", remarks) *
               clamp_factor(source.intensity, 0, kMostIntensity, "intensity", remarks));
    if (source.range && source.type != Light::Type::directional) {
        const double range = metres_per_unit * *source.range;
        const auto stored = static_cast<float>(range);
        if (range > 0 && stored > 0) {
            light.range = std::isfinite(stored) ? stored : 0.0f;
        } else {
            remarks.emplace_back("range is not above 0 and is taken as endless");
        }
    }
    if (source.type == Light::Type::spot) {
        constexpr double kWidest = std::numbers::pi / 2;
        // Exporters write the float next above pi / 2 for a half space.
        constexpr double kRounding = 1e-6, kNarrowest = 1e-4;
        const double outer =
            source.outer_cone > kWidest && source.outer_cone < kWidest + kRounding
                ? kWidest
                : clamp_factor(source.outer_cone, kNarrowest, kWidest, "outerConeAngle", remarks);
        double inner = source.inner_cone;
        if (!(inner < outer)) {
            remarks.emplace_back(
                "innerConeAngle is not below outerConeAngle: the light has a sharp edge");
            inner = outer * (1 - kRounding);
        } else if (!(inner >= 0)) {
            inner = clamp_factor(inner, 0, outer, "innerConeAngle", remarks);
        }
        light.inner_cone = static_cast<float>(inner);
        light.outer_cone = static_cast<float>(outer);
    }
    for (std::string& remark : remarks) {
        report.warn(label("light", index, source.name), std::move(remark));
    }
    return light;
}

/// False, with an error, where the node's transform leaves no place or direction.
bool place(const NodeInstance& node, const std::string& where, double metres_per_unit,
           glm::dvec3 origin, Light& light, Report& report) {
    const glm::vec3 position(metres_per_unit * glm::dvec3(node.world[3]) - origin);
    // A light shines along -z of its node.
    const glm::dvec3 axis = -glm::dvec3(node.world[2]);
    const double length = glm::length(axis);
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(position.z) ||
        !std::isfinite(length)) {
        report.error(where, "its light is too far away for single precision",
                     "move it closer to the scene");
        return false;
    }
    light.position = light.type == Light::Type::directional ? glm::vec3(0) : position;
    if (light.type == Light::Type::point) return true;
    if (!(length > 0)) {
        report.error(where, "its light has no direction: the node's scale along z is 0",
                     "give the node a scale above 0");
        return false;
    }
    light.direction = glm::vec3(axis / length);
    return true;
}

}  // namespace

void build_lights(const Document& document, const std::vector<NodeInstance>& nodes,
                  double metres_per_unit, Scene& scene, Report& report) {
    if (nodes.size() > kMaxWorldLights) {
        report.over_limit("KHR_lights_punctual",
                          "the scene has " + std::to_string(nodes.size()) +
                              " lights, the limit is " + std::to_string(kMaxWorldLights),
                          "remove lights, or use an emissive surface");
        return;
    }
    UniqueNames names;
    std::map<std::uint32_t, Light> converted;  // one light may be used by many nodes
    scene.lights.reserve(nodes.size());
    for (const NodeInstance& instance : nodes) {
        const Node& node = document.nodes[instance.node];
        const LightSource& source = document.lights[node.light];
        const auto known = converted.find(node.light);
        Light light =
            known != converted.end()
                ? known->second
                : converted
                      .emplace(node.light, convert(source, node.light, metres_per_unit, report))
                      .first->second;
        if (!place(instance, label("node", instance.node, node.name), metres_per_unit, scene.origin,
                   light, report)) {
            continue;
        }
        light.name = names.take(!node.name.empty()     ? node.name
                                : !source.name.empty() ? source.name
                                                       : "light");
        scene.lights.push_back(std::move(light));
    }
}

}  // namespace opaline::formats::gltf
