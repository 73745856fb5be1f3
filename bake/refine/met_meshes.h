#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "bake/scene/copies.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Where the meshes of a scene are, copies and originals each as one. The scene must outlive it.
class MetMeshes {
  public:
    explicit MetMeshes(const formats::Scene& scene);

    /// Whether a vertex of a copied mesh is a vertex of another one too, as where parts of a
    /// modular kit meet: edges that are halved on one side are halved on the other. True, too, of
    /// what is asked after some seconds of work, where thousands of meshes lie in each other.
    bool meets_another(const CopiedMesh& copy);

  private:
    struct Box {
        glm::vec3 low, high;  // [m]
    };
    struct Mesh {
        std::uint32_t place;         // its first primitive
        std::uint32_t first, count;  // primitives, whose arrays it has
        glm::vec3 offset;
        Box box;
    };
    Box box_of(std::uint32_t first, std::uint32_t count) const;
    bool share_a_vertex(const Mesh& a, const Mesh& b);

    const formats::Scene& scene_;
    std::uint64_t work_left_ = 200'000'000;  // vertices
    // By the exponent of their width along x, each sorted by where they begin: those that a box
    // overlaps lie in a short range of each.
    std::map<int, std::vector<Mesh>> by_width_;
};

}  // namespace opaline::bake
