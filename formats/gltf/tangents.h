#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "formats/scene.h"

namespace opaline::formats::gltf {

/// TANGENT of glTF (4 values a vertex), turned by a node's transform: directions by its linear
/// part, signs by its handedness. Lengths are kept; what is not finite becomes zero.
std::vector<glm::vec4> turn_tangents(const std::vector<float>& stored, const glm::dmat4& world);

/// Primitive::tangent of a primitive with normals and texture coordinates. What is there already
/// (turn_tangents) is made perpendicular to the normals and of unit length. Where that leaves no
/// direction, the triangles around the vertex give one, as MikkTSpace's do: dP/du, projected into
/// the vertex's tangent plane and weighted by the angle of the corner; where mirrored and plain
/// triangles share a vertex, those of the larger angle count. Vertices without either have zero.
void complete_tangents(Primitive& primitive);

}  // namespace opaline::formats::gltf
