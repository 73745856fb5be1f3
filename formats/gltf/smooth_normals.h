#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::formats::gltf {

/// One unit normal per vertex: the mean of the adjoining faces' normals, each weighted by the
/// angle that the face spans at the vertex. Vertices at exactly the same position share their
/// faces, so that duplicated vertices show no seam; where those faces cancel (the two sides of a
/// sheet), a vertex uses only its own. {0,0,0} where no face with an area adjoins.
/// `index`: three per triangle, counter-clockwise outside, each < position.size().
std::vector<glm::vec3> smooth_normals(std::span<const glm::vec3> position,
                                      std::span<const std::uint32_t> index);

}  // namespace opaline::formats::gltf
