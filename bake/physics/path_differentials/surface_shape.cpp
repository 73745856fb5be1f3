#include "bake/physics/path_differentials/surface_shape.h"

#include <algorithm>

namespace opaline::bake {

SurfaceShape interpolated_shape(const std::array<glm::dvec3, 3>& corners,
                                const std::array<glm::dvec3, 3>& normals, const glm::dvec3& P) {
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const glm::dvec3 n = glm::cross(e1, e2), e3 = e2 - e1;
    const double nn = glm::dot(n, n);
    const double edge2 = std::max({glm::dot(e1, e1), glm::dot(e2, e2), glm::dot(e3, e3)});
    glm::dvec3 bary(1.0 / 3);
    std::array<glm::dvec3, 3> gradient{};  // of each barycentric coordinate [1/m]
    if (nn >= 1e-24 * edge2 * edge2 && nn != 0) {
        const glm::dvec3 b = glm::cross(e2, n) / nn, c = glm::cross(n, e1) / nn;
        const glm::dvec3 from = P - corners[0];
        const double at_b = glm::dot(b, from), at_c = glm::dot(c, from);
        gradient = {-b - c, b, c};
        bary = {1 - at_b - at_c, at_b, at_c};
    }
    glm::dvec3 m(0);
    glm::dmat3 dm(0.0);
    for (int i = 0; i < 3; ++i) {
        const auto corner = static_cast<std::size_t>(i);
        m += bary[i] * normals[corner];
        dm += glm::outerProduct(normals[corner], gradient[corner]);
    }
    const double length = glm::length(m);
    const glm::dvec3 N = m / length;
    return {N, (dm - glm::outerProduct(N, N) * dm) / length};
}

}  // namespace opaline::bake
