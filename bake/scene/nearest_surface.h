#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// The triangles of one material, ready for searches of the nearest one. Immutable; any thread may
/// search.
class NearestSurface {
  public:
    NearestSurface(const formats::Scene& scene, std::uint32_t material);

    bool is_empty() const { return triangles_.empty(); }

    struct Place {
        std::uint32_t primitive = formats::kNone;  ///< number of formats::Scene; kNone: none
        std::uint32_t first_index = 0;             ///< of its triangle
        float u = 0, v = 0;                        ///< weights of its second and third corner
        float distance = 0;                        ///< [m]
    };
    /// The nearest point of the surface within `reach` [m]; of several triangles at one distance
    /// the first in the scene.
    Place find(glm::vec3 point, float reach = std::numeric_limits<float>::infinity()) const;

  private:
    struct Triangle {
        glm::vec3 corner[3];
        std::uint32_t primitive, first_index;
    };
    struct Node {
        glm::vec3 low, high;
        std::uint32_t first = 0, count = 0;  ///< triangles of a leaf; count 0: an inner node
        std::uint32_t second = 0;            ///< its second child; the first one follows it
    };
    struct Search;
    std::uint32_t build(std::uint32_t first, std::uint32_t last);
    void visit(std::uint32_t node, Search& search) const;

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

/// Nodes of a regular grid.
struct GridNodes {
    glm::vec3 low{0};     ///< [m] of the first one
    float cell = 1;       ///< [m] between neighbours, > 0
    glm::uvec3 count{0};  ///< along each axis; x varies fastest

    std::size_t size() const { return std::size_t{count.x} * count.y * count.z; }
    std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (std::size_t{z} * count.y + y) * count.x + x;
    }
    glm::vec3 position(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return low + cell * glm::vec3(x, y, z);
    }
};

/// The nearest point of a surface to each node. Within two cells of the surface it is searched for;
/// farther away it is the nearest of those that the neighbours have [Danielsson1980], which errs by
/// a share of a cell. The same for any number of threads. All are kNone if no node is that near.
std::vector<NearestSurface::Place> find_nearest(const formats::Scene& scene,
                                                const NearestSurface& surface,
                                                const GridNodes& nodes);

}  // namespace opaline::bake
