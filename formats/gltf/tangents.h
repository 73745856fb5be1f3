#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "formats/gltf/placement.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// TANGENT of glTF (4 values a vertex), turned as the vertices are: directions by the linear part
/// of the transform, signs by its handedness. Lengths are kept; what is not finite becomes zero.
std::vector<glm::vec4> turn_tangents(const std::vector<float>& stored, const Placement& placement);

/// Primitive::tangent of a primitive with normals and texture coordinates. What is there already
/// (turn_tangents) is made perpendicular to the normals and of unit length. Where that leaves no
/// direction, the triangles around the vertex give one, as MikkTSpace's do: dP/du, projected into
/// the vertex's tangent plane and weighted by the angle of the corner; where mirrored and plain
/// triangles share a vertex, those of the larger angle count. Vertices without either have zero.
void complete_tangents(Primitive& primitive);

}  // namespace opaline::formats::gltf
