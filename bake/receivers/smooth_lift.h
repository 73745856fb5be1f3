#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "formats/scene.h"

namespace opaline::bake {

/// The offset [m] from a point of a facet, at `position` [m], to the smooth surface through its
/// corners [Hanika2021]: the mean offset to the corners' tangent planes, counting those that the
/// point lies below. `first_index`: of the triangle, into Primitive::index. Corners that a baker
/// added lie on facets of the file and are lifted first (lift_of_vertex), so that a surface is the
/// same however finely it is divided.
glm::vec3 lift_to_smooth_surface(const formats::Primitive& primitive, std::uint32_t first_index,
                                 glm::vec3 barycentric, glm::vec3 position);

/// The same of a vertex: 0 of those that the file has.
glm::vec3 lift_of_vertex(const formats::Primitive& primitive, std::uint32_t vertex);

}  // namespace opaline::bake
