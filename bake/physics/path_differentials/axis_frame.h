#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace opaline::bake {

/// Columns T, B, n of a right-handed orthonormal frame around a unit vector [Duff2017]: `Frame` of
/// bake/base in double precision, in which derivatives are told apart.
inline glm::dmat3 frame_around(const glm::dvec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// How a direction that is fixed in a frame around the unit axis R moves when the axis moves by dR:
/// the frame turns by R x dR and does not spin around R. A lobe is symmetric around its axis, so
/// spin changes no density; a recipe for T and B would add its own, which diverges where the recipe
/// has a pole. dot(R, direction) stays as it is.
inline glm::dvec3 carry_with_axis(const glm::dvec3& axis, const glm::dvec3& daxis,
                                  const glm::dvec3& direction) {
    return glm::cross(glm::cross(axis, daxis), direction);
}

}  // namespace opaline::bake
