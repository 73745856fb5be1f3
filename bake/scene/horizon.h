#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A tree over triangles that bounds how high they rise above a plane.
struct HorizonTree {
    using Triangle = std::array<glm::vec3, 3>;  ///< corners [m]
    /// All triangles of a node lie in a ball and in a slab across `axis`; the slab is thin where
    /// the surface is smooth.
    struct Node {
        glm::dvec3 centre{0}, axis{0};       ///< [m]; unit
        double radius = 0;                   ///< [m]
        double low = 0, high = 0;            ///< of the slab, along `axis` from `centre` [m]
        std::uint32_t first = 0, count = 0;  ///< triangles
        std::uint32_t right = 0;  ///< its second child, the first stands next to it; 0: a leaf
    };
    std::vector<Triangle> triangle;  ///< those of a node side by side
    std::vector<Node> node;          ///< the root first
};

/// Triangles without area are left out: no ray can hit them.
HorizonTree make_horizon_tree(std::vector<HorizonTree::Triangle> triangles);

/// All triangles of primitives of one material, or of the scene.
HorizonTree make_horizon_tree(const formats::Scene& scene,
                              std::optional<std::uint32_t> material = {});

/// Visits the triangles of all nodes for which `enters(node)`.
template <class Enters, class Visit>
void walk_tree(const HorizonTree& tree, const Enters& enters, const Visit& visit) {
    // At most two splits by facing along each axis, then halving: a depth of at most 6 + 32.
    std::array<std::uint32_t, 64> open;
    std::size_t count = 0;
    if (!tree.node.empty()) open[count++] = 0;
    while (count > 0) {
        const std::uint32_t at = open[--count];
        const HorizonTree::Node& node = tree.node[at];
        if (!enters(node)) continue;
        if (node.right != 0) {
            open[count++] = node.right;
            open[count++] = at + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            visit(tree.triangle[i]);
        }
    }
}

/// Largest coordinate along `direction` of any point of the triangles [m].
double farthest_along(const HorizonTree& tree, glm::dvec3 direction);

/// State of a search for the highest triangle above many horizons.
struct HorizonSearch {
    /// Bound on the sine of the elevation of any triangle above a horizon, over the horizons
    /// searched so far; never below its initial value.
    double sine = 0;
    double flat = 0;              ///< heights over a plane up to this count as 0 [m]
    double stop_above = 1;        ///< a higher sine ends the search
    std::int64_t nodes_left = 1;  ///< work that may still be spent
    bool is_over() const { return sine > stop_above || nodes_left <= 0; }
};

/// Looks at all triangles over the horizon of one point: the plane across `normal` (unit) through
/// `point`. Exact for triangles that do not rise above it; for others the bound is
///     highest corner's height / distance to the triangle,
/// or, if they begin at the point itself, the larger sine of its two corners there, divided by the
/// cosine of half the angle between them.
void look_over_horizon(const HorizonTree& tree, glm::vec3 point, glm::dvec3 normal,
                       HorizonSearch& search);

}  // namespace opaline::bake
