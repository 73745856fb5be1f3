#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace opaline::bake {

/// A point of a surface, and how it moves with u and v.
struct AreaSample {
    glm::dvec3 P{0};
    glm::dvec3 dP_du{0}, dP_dv{0};  ///< [m]; |dP_du x dP_dv| is the area
};

/// A + u e1 + v e2: a rectangle, or any parallelogram.
inline AreaSample sample_parallelogram(const glm::dvec3& A, const glm::dvec3& e1,
                                       const glm::dvec3& e2, double u, double v) {
    return {A + u * e1 + v * e2, e1, e2};
}

/// Uniform in a triangle: the square is folded along its diagonal. Columns are constant on either
/// side of it. u, v in [0, 1].
inline AreaSample sample_triangle_folded(const std::array<glm::dvec3, 3>& corners, double u,
                                         double v) {
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    if (v > u) {
        return {corners[0] + u / 2 * e1 + (v - u / 2) * e2, (e1 - e2) / 2.0, e2};
    }
    return {corners[0] + (u - v / 2) * e1 + v / 2 * e2, e1, (e2 - e1) / 2.0};
}

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
