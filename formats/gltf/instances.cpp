#include "formats/gltf/instances.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "formats/gltf/read_accessor.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

/// One attribute of all instances; empty where it is missing or at fault.
std::vector<float> read(const Document& document, const std::vector<Bytes>& buffers,
                        const Node& node, const char* semantic, std::uint32_t components,
                        const std::string& where, Report& report) {
    const auto found = node.instances.find(semantic);
    if (found == node.instances.end()) {
        return {};
    }
    const Accessor& accessor = document.accessors[found->second];
    const bool whole = accessor.type != ComponentType::float32;
    if (accessor.is_matrix || accessor.components != components ||
        (whole && !accessor.normalized && components == 4)) {
        report.error(where, std::string(semantic) + " has not " + std::to_string(components) +
                                " floats or normalised integers per instance");
        return {};
    }
    auto values = read_floats(document, buffers, found->second);
    if (values.sparse_index_bad) {
        report.error(where, std::string(semantic) + " has a sparse index past its last element");
        return {};
    }
    for (std::size_t i = 0; i < values.value.size(); ++i) {
        if (!std::isfinite(values.value[i])) {
            report.error(where, std::string(semantic) + " of instance " +
                                    std::to_string(i / components) + " is not finite");
            return {};
        }
    }
    return std::move(values.value);
}

}  // namespace

Attributes read_instances(const NamedObject& node) {
    Attributes instances;
    const auto extension = node.extensions().member(kInstancing);
    const auto attributes = extension ? extension->member("attributes") : std::nullopt;
    if (extension && !attributes) {
        node.report.error(extension->where, "it has no attributes");
    }
    if (!attributes) return instances;
    for (const auto& [semantic, accessor] : attributes->object.items()) {
        if (const auto index = whole_in(attributes->object, semantic.c_str(), kNone - 1)) {
            instances.emplace(semantic, static_cast<std::uint32_t>(*index));
        } else {
            node.report.error(extension->where, in_quotes(semantic) + " is not an accessor");
        }
    }
    return instances;
}

std::uint64_t instance_count(const Document& document, const Node& node) {
    return node.instances.empty() ? 1 : document.accessors[node.instances.begin()->second].count;
}

std::vector<glm::dmat4> instance_transforms(const Document& document,
                                            const std::vector<Bytes>& buffers, const Node& node,
                                            const std::string& where, Report& report) {
    const std::uint64_t count = instance_count(document, node);
    for (const auto& [semantic, accessor] : node.instances) {
        if (const std::uint64_t other = document.accessors[accessor].count; other != count) {
            report.error(where,
                         std::string(kInstancing) + ": " + in_quotes(semantic) + " has " +
                             std::to_string(other) + " values, but " +
                             in_quotes(node.instances.begin()->first) + " has " +
                             std::to_string(count),
                         "export with one value per instance");
            return {};
        }
    }
    const std::size_t faults = report.error_count();
    const auto values = [&](const char* semantic, std::uint32_t components) {
        return read(document, buffers, node, semantic, components, where + " > " + kInstancing,
                    report);
    };
    const std::vector<float> translation = values("TRANSLATION", 3),
                             rotation = values("ROTATION", 4), scale = values("SCALE", 3);
    if (report.error_count() != faults) {
        return {};
    }
    std::vector<glm::dmat4> places(count, glm::dmat4(1.0));
    for (std::size_t i = 0; i < count; ++i) {
        glm::dmat4& place = places[i];
        if (!rotation.empty()) {
            const float* q = &rotation[4 * i];
            const glm::dquat turn(q[3], q[0], q[1], q[2]);
            const double length = glm::length(turn);
            if (!(length > 1e-6)) {
                report.error(where, std::string(kInstancing) + ": ROTATION of instance " +
                                        std::to_string(i) + " is not a unit quaternion");
                return {};
            }
            place = glm::mat4_cast(turn / length);
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (!scale.empty()) {
                place[axis] *= static_cast<double>(scale[3 * i + static_cast<std::size_t>(axis)]);
            }
            if (!translation.empty()) {
                place[3][axis] = translation[3 * i + static_cast<std::size_t>(axis)];
            }
        }
    }
    return places;
}

}  // namespace opaline::formats::gltf
