#include "bake/path_differentials/surface_shape.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

/// d(m / |m|) for a linear change of m.
glm::dmat3 normalized_change(const glm::dvec3& N, double length, const glm::dmat3& dm) {
    return (dm - glm::outerProduct(N, N) * dm) / length;
}

}  // namespace

TriangleGradients triangle_gradients(const std::array<glm::dvec3, 3>& corners,
                                     const glm::dvec3& P) {
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const glm::dvec3 n = glm::cross(e1, e2), e3 = e2 - e1;
    const double nn = glm::dot(n, n);
    const double edge2 = std::max({glm::dot(e1, e1), glm::dot(e2, e2), glm::dot(e3, e3)});
    if (!(nn >= 1e-24 * edge2 * edge2) || nn == 0) {
        return {};
    }
    const glm::dvec3 b = glm::cross(e2, n) / nn, c = glm::cross(n, e1) / nn;
    const glm::dvec3 from = P - corners[0];
    const double at_b = glm::dot(b, from), at_c = glm::dot(c, from);
    return {{-b - c, b, c}, {1 - at_b - at_c, at_b, at_c}};
}

SurfaceShape interpolated_shape(const TriangleGradients& at, const TriangleAttributes& attributes) {
    glm::dvec3 m(0);
    glm::dmat3 dm(0.0);
    SurfaceShape shape;
    for (int i = 0; i < 3; ++i) {
        const auto corner = static_cast<std::size_t>(i);
        m += at.bary[i] * attributes.normal[corner];
        dm += glm::outerProduct(attributes.normal[corner], at.gradient[corner]);
        shape.duv_dP += glm::outerProduct(attributes.uv[corner], at.gradient[corner]);
    }
    const double length = glm::length(m);
    shape.N = m / length;
    shape.dN_dP = normalized_change(shape.N, length, dm);
    return shape;
}

SurfaceShape sphere_shape(const glm::dvec3& center, double radius, const glm::dvec3& P) {
    return {(P - center) / radius, glm::dmat3(1 / radius), glm::dmat3x2(0.0)};
}

}  // namespace opaline::bake
