#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace opaline::bake {

/// Corners of a triangle as vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// An indexed mesh with shared vertices. The example scenes model in millimetres and scale once,
/// before writing.
struct TriangleMesh {
    std::vector<glm::dvec3> position;
    std::vector<glm::dvec3> normal;  ///< unit, one per vertex, outward
    std::vector<Triangle> triangles;
};

}  // namespace opaline::bake
