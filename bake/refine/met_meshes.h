#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/scene/copies.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Where the meshes of a scene are, copies and originals each as one. The scene must outlive it.
class MetMeshes {
  public:
    explicit MetMeshes(const formats::Scene& scene);

    /// Whether a vertex of a copied mesh is a vertex of another one too, as where parts of a
    /// modular kit meet: edges that are halved on one side are halved on the other.
    bool meets_another(const CopiedMesh& mesh) const;

  private:
    struct Mesh {
        std::uint32_t first, count;  // primitives, whose arrays it has
        glm::vec3 offset, low, high;
    };
    void add(std::uint32_t first, std::uint32_t count, glm::vec3 offset);

    const formats::Scene& scene_;
    std::vector<Mesh> meshes_;
};

}  // namespace opaline::bake
