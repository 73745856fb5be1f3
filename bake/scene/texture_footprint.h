#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "bake/scene/texture_taps.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Change of a triangle's texture coordinates over its plane [1/m], d(uv)/dP, beyond its edges too.
/// 0 without coordinates or area. `first_index`: of its first corner in Primitive::index.
glm::dmat3x2 uv_gradient(const formats::Primitive& primitive, std::uint32_t first_index);

/// Of a square of that area [m^2] in the plane, turned in any way: a cell of which no more is
/// known.
UvMoments moments_of_area(const glm::dmat3x2& duv_dP, double area);

/// Of a parallelogram with these edges [m].
UvMoments moments_of_edges(const glm::dmat3x2& duv_dP, const glm::dvec3& a, const glm::dvec3& b);

/// Of the part of a surface that is seen in a small cone around a ray of `distance` [m] that meets
/// it: a square of `solid_angle` [sr] thrown onto the plane. `direction`, `normal`: unit.
UvMoments moments_of_cone(const glm::dmat3x2& duv_dP, const glm::dvec3& direction,
                          const glm::dvec3& normal, double distance, double solid_angle);

/// Of a triangle with these texture coordinates.
UvMoments moments_of_triangle(const std::array<glm::dvec2, 3>& uv);

}  // namespace opaline::bake
