#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

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
