#include "formats/gltf/walk_scene.h"

#include <set>
#include <string>

namespace opaline::formats::gltf {

namespace {

std::vector<std::uint32_t> scene_roots(const Document& document, Report& report) {
    if (!document.scenes.empty()) {
        const std::uint32_t chosen = document.default_scene == kNone ? 0 : document.default_scene;
        if (document.scenes.size() > 1) {
            report.warn(
                "scene " + std::to_string(chosen),
                "only this scene is read: the file has " + std::to_string(document.scenes.size()),
                "export each scene to its own file");
        }
        return document.scenes[chosen];
    }
    std::vector<bool> is_child(document.nodes.size(), false);
    for (const Node& node : document.nodes) {
        for (const std::uint32_t child : node.children) {
            is_child[child] = true;
        }
    }
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < document.nodes.size(); ++i) {
        if (!is_child[i]) {
            roots.push_back(i);
        }
    }
    return roots;
}

bool is_past_limits(const SceneCounts& counts) {
    return counts.vertices > kMaxWorldVertices || counts.indices > kMaxWorldIndices ||
           counts.primitives > kMaxWorldPrimitives;
}

// Past a limit it stops counting.
SceneCounts count_instances(const Document& document, const std::vector<MeshInstance>& instances,
                            std::uint32_t& last_node) {
    SceneCounts counts;
    for (const MeshInstance& instance : instances) {
        last_node = instance.node;
        for (const MeshPrimitive& primitive :
             document.meshes[document.nodes[instance.node].mesh].primitives) {
            const auto position = primitive.attributes.find("POSITION");
            if (position == primitive.attributes.end()) {
                continue;
            }
            const std::uint64_t count = document.accessors[position->second].count;
            const std::uint64_t drawn =
                primitive.indices == kNone ? count : document.accessors[primitive.indices].count;
            counts.vertices += count;
            counts.indices += primitive.mode == Mode::triangles ? drawn : 3 * drawn;
            ++counts.primitives;
            if (is_past_limits(counts)) {
                return counts;
            }
        }
    }
    return counts;
}

void check_totals(const Document& document, const std::vector<MeshInstance>& instances,
                  Report& report) {
    std::uint32_t node = 0;
    if (is_past_limits(count_instances(document, instances, node))) {
        report.over_limit(label("node", node, document.nodes[node].name),
                          "with all instances the scene passes " +
                              std::to_string(kMaxWorldVertices) + " vertices, " +
                              std::to_string(kMaxWorldIndices) + " indices or " +
                              std::to_string(kMaxWorldPrimitives) + " primitives",
                          "split or simplify the scene");
    }
}

}  // namespace

SceneCounts count_world(const Document& document, const std::vector<MeshInstance>& instances) {
    std::uint32_t node = 0;
    return count_instances(document, instances, node);
}

SceneNodes walk_scene(const Document& document, Report& report) {
    SceneNodes found;
    std::vector<NodeInstance> pending;
    const auto roots = scene_roots(document, report);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
        pending.push_back({*root, document.nodes[*root].local});
    }
    std::size_t skinned = 0, cameras = 0;
    std::set<std::string> extensions;
    while (!pending.empty()) {
        const NodeInstance at = pending.back();
        pending.pop_back();
        const Node& node = document.nodes[at.node];
        skinned += node.has_skin ? 1 : 0;
        cameras += node.has_camera ? 1 : 0;
        extensions.insert(node.extensions.begin(), node.extensions.end());
        if (node.mesh != kNone) {
            found.meshes.push_back(at);
        }
        if (node.light != kNone) {
            found.lights.push_back(at);
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            pending.push_back({*child, at.world * document.nodes[*child].local});
        }
    }
    if (skinned > 0) {
        report.warn("",
                    "skins are not simulated: " + std::to_string(skinned) +
                        " skinned nodes are baked in their bind pose, placed by their node",
                    "apply the pose before export");
    }
    if (document.has_animations) {
        report.warn("", "animations are not simulated: the scene is baked as it stands at rest");
    }
    if (cameras > 0) {
        report.warn("", "cameras of the file are not used", "give the camera when rendering");
    }
    for (const std::string& name : extensions) {
        if (name != "KHR_lights_punctual") {
            report.warn("", "node extension " + in_quotes(name) + " is not simulated");
        }
    }
    check_totals(document, found.meshes, report);
    return found;
}

}  // namespace opaline::formats::gltf
