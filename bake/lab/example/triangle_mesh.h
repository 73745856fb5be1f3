#pragma once

#include <array>
#include <cstddef>
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

/// Adds the triangles of a grid of (columns + 1) x (rows + 1) vertices from `first` on, rows one
/// after another.
inline void join_grid(TriangleMesh& mesh, unsigned columns, unsigned rows, std::size_t first = 0) {
    const std::uint32_t row = columns + 1;
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t v = static_cast<std::uint32_t>(first) + j * row + i;
            mesh.triangles.push_back({v, v + 1, v + row + 1});
            mesh.triangles.push_back({v, v + row + 1, v + row});
        }
    }
}

/// Adds the parallelogram corner + s along + t up, s and t in [0, 1], cut into columns x rows
/// cells; its front has the normal of cross(along, up).
inline void append_grid(TriangleMesh& mesh, unsigned columns, unsigned rows,
                        const glm::dvec3& corner, const glm::dvec3& along, const glm::dvec3& up) {
    const std::size_t first = mesh.position.size();
    const glm::dvec3 normal = glm::normalize(glm::cross(along, up));
    for (unsigned j = 0; j <= rows; ++j) {
        for (unsigned i = 0; i <= columns; ++i) {
            mesh.position.push_back(corner + along * (static_cast<double>(i) / columns) +
                                    up * (static_cast<double>(j) / rows));
            mesh.normal.push_back(normal);
        }
    }
    join_grid(mesh, columns, rows, first);
}

}  // namespace opaline::bake
