#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "formats/gltf/read_primitive.h"
#include "formats/gltf/report.h"
#include "formats/gltf/walk_scene.h"

namespace opaline::formats::gltf {

/// Where the vertices of a primitive stand: from the mesh's frame to the scene's, file units.
struct Placement {
    glm::dmat4 world{1.0};
    std::vector<glm::dmat4> skinned;  ///< one per vertex, in place of `world`; empty without a skin
    bool is_mirrored = false;         ///< of most vertices

    const glm::dmat4& at(std::size_t vertex) const {
        return skinned.empty() ? world : skinned[vertex];
    }
};

/// The node's transform or, where it has a skin, that of the joints alone (glTF 2.0, 3.7.3.3): the
/// mean of their matrices, weighted as the vertex says. Errors are named after `where`. A primitive
/// without JOINTS_0 stands by its node, with a warning.
Placement place_primitive(const MeshInstance& instance, const PrimitiveData& data,
                          const std::string& where, Report& report);

}  // namespace opaline::formats::gltf
