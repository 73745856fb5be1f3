#include "formats/gltf/walk_scene.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <set>
#include <string>

#include "formats/gltf/instances.h"
#include "formats/gltf/read_accessor.h"

namespace opaline::formats::gltf {

namespace {

/// The parent of every node, kNone of roots.
std::vector<std::uint32_t> find_parents(const Document& document) {
    std::vector<std::uint32_t> parent(document.nodes.size(), kNone);
    for (std::uint32_t i = 0; i < document.nodes.size(); ++i) {
        for (const std::uint32_t child : document.nodes[i].children) {
            parent[child] = i;
        }
    }
    return parent;
}

/// Every node after its parent.
std::vector<std::uint32_t> from_the_roots(const Document& document,
                                          const std::vector<std::uint32_t>& parent) {
    std::vector<std::uint32_t> order;
    order.reserve(parent.size());
    for (std::uint32_t i = 0; i < parent.size(); ++i) {
        if (parent[i] == kNone) {
            order.push_back(i);
        }
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto& children = document.nodes[order[i]].children;
        order.insert(order.end(), children.begin(), children.end());
    }
    return order;
}

/// The nodes that a scene's own list places: each once, none below another one.
std::vector<std::uint32_t> roots_of_list(const Document& document, std::uint32_t scene,
                                         const std::vector<std::uint32_t>& parent,
                                         const std::vector<std::uint32_t>& order, Report& report) {
    std::vector<bool> is_listed(parent.size(), false), is_below(parent.size(), false);
    for (const std::uint32_t node : document.scenes[scene]) {
        is_listed[node] = true;
    }
    for (const std::uint32_t node : order) {
        is_below[node] =
            parent[node] != kNone && (is_below[parent[node]] || is_listed[parent[node]]);
    }
    std::vector<std::uint32_t> roots;
    std::vector<bool> is_placed(parent.size(), false);
    std::size_t repeated = 0, below = 0, alone = 0;
    std::uint32_t last_below = kNone, last_alone = kNone;
    for (const std::uint32_t node : document.scenes[scene]) {
        if (is_below[node]) {
            ++below;
            last_below = node;
        } else if (is_placed[node]) {
            ++repeated;
        } else {
            is_placed[node] = true;
            roots.push_back(node);
            if (parent[node] != kNone) {
                ++alone;
                last_alone = node;
            }
        }
    }
    const auto warn = [&](std::size_t count, const std::string& what) {
        if (count > 0) {
            report.warn("scene " + std::to_string(scene), what,
                        "list every root node once, and no other node");
        }
    };
    const auto name = [&](std::uint32_t node) {
        return node == kNone ? "" : label("node", node, document.nodes[node].name);
    };
    warn(repeated, "it lists a node twice: the node is placed once");
    warn(below, "it lists " + name(last_below) + " and a parent of it" +
                    (below > 1 ? ", and so " + std::to_string(below - 1) + " more" : "") +
                    ": a node is placed once, by its parent");
    warn(alone, "it lists " + name(last_alone) + " without its parent" +
                    (alone > 1 ? ", and so " + std::to_string(alone - 1) + " more" : "") +
                    ": it stands as if it had none");
    return roots;
}

std::vector<std::uint32_t> scene_roots(const Document& document,
                                       const std::vector<std::uint32_t>& parent,
                                       const std::vector<std::uint32_t>& order, Report& report) {
    if (!document.scenes.empty()) {
        const std::uint32_t chosen = document.default_scene == kNone ? 0 : document.default_scene;
        if (document.scenes.size() > 1) {
            report.warn(
                "scene " + std::to_string(chosen),
                "only this scene is read: the file has " + std::to_string(document.scenes.size()),
                "export each scene to its own file");
        }
        return roots_of_list(document, chosen, parent, order, report);
    }
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < parent.size(); ++i) {
        if (parent[i] == kNone) {
            roots.push_back(i);
        }
    }
    return roots;
}

/// Where the joints of a skin take a vertex: the joint's transform after its inverse bind matrix.
std::vector<glm::dmat4> joint_matrices(const Document& document, const std::vector<Bytes>& buffers,
                                       const Skin& skin, const std::vector<glm::dmat4>& world) {
    std::vector<glm::dmat4> matrices;
    matrices.reserve(skin.joints.size());
    for (const std::uint32_t joint : skin.joints) {
        matrices.push_back(world[joint]);
    }
    if (skin.inverse_bind_matrices != kNone) {
        const std::vector<float> bind =
            read_floats(document, buffers, skin.inverse_bind_matrices).value;
        for (std::size_t j = 0; j < matrices.size(); ++j) {
            matrices[j] = matrices[j] * glm::dmat4(glm::make_mat4(&bind[16 * j]));
        }
    }
    return matrices;
}

/// Appends a node's mesh at each of its places; false, with an error, past the limits.
bool add_mesh(const Document& document, const std::vector<Bytes>& buffers, const NodeInstance& at,
              std::vector<MeshInstance>& meshes, Report& report) {
    const Node& node = document.nodes[at.node];
    const std::string where = label("node", at.node, node.name);
    if (node.instances.empty()) {
        meshes.push_back({at, kNone, {}});
        return true;
    }
    if (node.skin != kNone) {
        report.warn(where, std::string(kInstancing) +
                               " is not simulated of a skinned mesh: it is placed once");
        meshes.push_back({at, kNone, {}});
        return true;
    }
    const std::uint64_t count = instance_count(document, node);
    if (count > kMaxWorldPrimitives - std::min(kMaxWorldPrimitives, meshes.size())) {
        report.over_limit(where,
                          "with its " + std::to_string(count) + " instances the scene passes " +
                              std::to_string(kMaxWorldPrimitives) + " primitives",
                          "split or simplify the scene");
        return false;
    }
    const auto places = instance_transforms(document, buffers, node, where, report);
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        meshes.push_back({{at.node, at.world * places[i]}, i, {}});
    }
    return true;
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
            if (position == primitive.attributes.end()) continue;
            const std::uint64_t count = document.accessors[position->second].count;
            const std::uint64_t drawn =
                primitive.indices == kNone ? count : document.accessors[primitive.indices].count;
            counts.vertices += count;
            counts.indices += primitive.mode == Mode::triangles ? drawn : 3 * drawn;
            ++counts.primitives;
            if (is_past_limits(counts)) return counts;
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

SceneNodes walk_scene(const Document& document, const std::vector<Bytes>& buffers, Report& report) {
    SceneNodes found;
    const std::vector<std::uint32_t> parent = find_parents(document);
    const std::vector<std::uint32_t> order = from_the_roots(document, parent);
    // Joints may stand outside of the scene: those have the transforms of their own roots.
    std::vector<glm::dmat4> world(document.nodes.size());
    for (const std::uint32_t node : order) {
        const glm::dmat4& local = document.nodes[node].local;
        world[node] = parent[node] == kNone ? local : world[parent[node]] * local;
    }
    std::vector<std::uint32_t> pending = scene_roots(document, parent, order, report);
    for (const std::uint32_t root : pending) {
        world[root] = document.nodes[root].local;
    }
    std::reverse(pending.begin(), pending.end());
    std::size_t cameras = 0;
    std::set<std::string> extensions;
    while (!pending.empty()) {
        const NodeInstance at{pending.back(), world[pending.back()]};
        pending.pop_back();
        const Node& node = document.nodes[at.node];
        cameras += node.has_camera ? 1 : 0;
        extensions.insert(node.extensions.begin(), node.extensions.end());
        if (node.mesh != kNone && !add_mesh(document, buffers, at, found.meshes, report)) {
            return found;
        }
        if (node.light != kNone) {
            found.lights.push_back(at);
        }
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            world[*child] = at.world * document.nodes[*child].local;
            pending.push_back(*child);
        }
    }
    std::size_t joints = 0;
    for (MeshInstance& mesh : found.meshes) {
        if (const std::uint32_t skin = document.nodes[mesh.node].skin; skin != kNone) {
            joints += document.skins[skin].joints.size();
            if (joints > kMaxWorldJoints) {
                report.over_limit(
                    label("node", mesh.node, document.nodes[mesh.node].name),
                    "with its skin the scene passes " + std::to_string(kMaxWorldJoints) + " joints",
                    "apply the pose before export");
                return found;
            }
            mesh.joints = joint_matrices(document, buffers, document.skins[skin], world);
        }
    }
    if (document.has_animations) {
        report.warn("", "animations are not simulated: the scene is baked as it stands at rest");
    }
    if (cameras > 0) {
        report.warn("", "cameras of the file are not used", "give the camera when rendering");
    }
    for (const std::string& name : extensions) {
        if (name != "KHR_lights_punctual" && name != kInstancing) {
            report.warn("", "node extension " + in_quotes(name) + " is not simulated");
        }
    }
    check_totals(document, found.meshes, report);
    return found;
}

}  // namespace opaline::formats::gltf
