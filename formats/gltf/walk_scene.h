#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// A node of the default scene.
struct NodeInstance {
    std::uint32_t node = 0;
    glm::dmat4 world{1.0};  ///< from the node's frame to the scene's, file units
};

/// One place of the mesh of a node.
struct MeshInstance : NodeInstance {
    std::uint32_t copy = kNone;      ///< which of EXT_mesh_gpu_instancing; none: the only one
    std::vector<glm::dmat4> joints;  ///< of a skin, from the mesh's frame to the scene's; or empty
};

/// The nodes of the default scene that carry something, depth-first.
struct SceneNodes {
    std::vector<MeshInstance> meshes;
    std::vector<NodeInstance> lights;
};

/// What the primitives of all instances hold, as their accessors state it.
SceneCounts count_world(const Document& document, const std::vector<MeshInstance>& instances);

/// Meshes in running-number order: nodes depth-first, children in their listed order, instances of
/// a node in the order of their attributes. Where the file names no scene, the first one; where it
/// has none, all nodes without a parent. A node that a scene lists beside an ancestor stands by its
/// parent; one that it lists without stands as if it had no parent. Reports instance counts past
/// the limits, and node extensions that are not simulated.
SceneNodes walk_scene(const Document& document, const std::vector<Bytes>& buffers, Report& report);

}  // namespace opaline::formats::gltf
