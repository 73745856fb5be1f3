#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace opaline::bake {

/// Triangles in a tree that tells how high a part of them rises above any plane.
struct HorizonTree {
    using Triangle = std::array<glm::vec3, 3>;  ///< corners [m]
    /// All triangles of a node lie in a ball, and in a slab across `axis`, which is thin where the
    /// surface is smooth.
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

/// Coordinate along `direction` of the point of all triangles that is farthest that way [m].
double farthest_along(const HorizonTree& tree, glm::dvec3 direction);

/// How a search for the highest triangle above many horizons stands.
struct HorizonSearch {
    /// Bound on the sine of the elevation above a horizon of any point of any triangle, over all
    /// that was looked at so far. Of what lies lower than at first nothing is said.
    double sine = 0;
    double flat = 0;              ///< heights over a plane that count as none [m]
    double stop_above = 1;        ///< with a higher one the search is over
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
