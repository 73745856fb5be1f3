#pragma once

#include <array>
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
AreaSample sample_triangle_folded(const std::array<glm::dvec3, 3>& corners, double u, double v);

/// Uniform in a triangle, by sqrt(u): dP_du is unbounded at the corner u = 0. u in (0, 1].
AreaSample sample_triangle_sqrt(const std::array<glm::dvec3, 3>& corners, double u, double v);

}  // namespace opaline::bake
