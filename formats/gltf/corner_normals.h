#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::formats::gltf {

/// The normal of each corner of each triangle.
struct CornerNormals {
    std::vector<glm::vec3> normal;     ///< unit; {0,0,0} at corners of a triangle without an area
    std::vector<std::uint32_t> group;  ///< corners of one group have one position and one normal
};

/// Triangles that share an edge are smooth across it where their normals differ by less than
/// `most_angle` [rad, 0 to pi]; a corner's normal is the mean over the triangles that it is
/// connected to by such edges around its position, each weighted by its angle there. Positions
/// that are exactly the same are one, so that duplicated vertices show no seam. Angles below .06
/// degrees are always smooth: floats hold planes no better.
/// `index`: three per triangle, counter-clockwise outside, each < position.size().
CornerNormals corner_normals(std::span<const glm::vec3> position,
                             std::span<const std::uint32_t> index, double most_angle);

}  // namespace opaline::formats::gltf
