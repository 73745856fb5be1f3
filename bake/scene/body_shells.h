#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A triangle of a material's surface.
struct BodyTriangle {
    std::array<std::uint32_t, 3> point;    ///< indices into BodyShells::position
    std::uint32_t primitive, first_index;  ///< where it stands in the scene
    bool turned = false;                   ///< faces the other way than in the scene
    bool is_at_end = false;                ///< an odd number of triangles meet at one of its edges
};

/// A connected set of triangles.
struct BodyShell {
    std::uint32_t first = 0, count = 0;  ///< in BodyShells::order
    glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
    double volume = 0;  ///< [m^3] enclosed, < 0 if it faces inward; about its centre if it is open
    double area = 0;    ///< [m^2]
    /// Sine of the sharpest edge at which two neighbours fold toward the side that they face, and
    /// away from it; 1 beyond a right angle. In a closed convex shell that faces outward `valley`
    /// is 0: folds below the rounding error of the coordinates do not count.
    double valley = 0, ridge = 0;
    double sharp = 0;      ///< [m] length of ridges of more than 45 degrees
    bool inside = false;   ///< of another shell
    bool is_open = false;  ///< has an edge at which an odd number of triangles meet
};

/// The surface of one material, shell by shell.
struct BodyShells {
    std::vector<glm::vec3> position;  ///< [m], each distinct position once
    std::vector<BodyTriangle> triangle;
    std::vector<BodyShell> shell;
    std::vector<std::uint32_t> order;  ///< triangles, shell by shell
    std::uint64_t open_edges = 0;      ///< at which an odd number of triangles meet
};

/// Corners in the order that `turned` gives them [m].
std::array<glm::dvec3, 3> corners(const BodyShells& body, const BodyTriangle& t);
/// Normal times area [m^2].
glm::dvec3 area_vector(const BodyShells& body, const BodyTriangle& t);

/// The triangles of some primitives, as the scene turns them, not cut into shells: `position` and
/// `triangle` alone. Those folded to a line are left out.
BodyShells weld_triangles(const formats::Scene& scene, std::span<const std::uint32_t> primitives);

/// The shells of a material's surface. Vertices at one position are one point. Triangles are
/// connected if they share an edge with exactly one other triangle. The smaller part of a shell by
/// area is turned, so that the whole shell faces one way. Triangles folded to a line are left out.
BodyShells make_body_shells(const formats::Scene& scene, std::uint32_t material);
/// As the former, of all materials that are chosen, or of some primitives.
BodyShells make_body_shells(const formats::Scene& scene, const std::vector<bool>& chosen);
BodyShells make_body_shells(const formats::Scene& scene, std::span<const std::uint32_t> primitives);

}  // namespace opaline::bake
