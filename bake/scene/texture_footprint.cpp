#include "bake/scene/texture_footprint.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {

glm::dmat3x2 uv_gradient(const formats::Primitive& primitive, std::uint32_t first_index) {
    if (primitive.texcoord.empty()) return glm::dmat3x2(0.0);
    const std::uint32_t* const i = &primitive.index[first_index];
    const glm::dvec3 origin(primitive.position[i[0]]);
    const glm::dvec3 s = glm::dvec3(primitive.position[i[1]]) - origin;
    const glm::dvec3 t = glm::dvec3(primitive.position[i[2]]) - origin;
    const glm::dvec3 n = glm::cross(s, t);
    const double square = glm::dot(n, n);
    if (!(square > 1e-24 * glm::dot(s, s) * glm::dot(t, t))) return glm::dmat3x2(0.0);
    // Gradients of the weights of the second and third corner.
    const glm::dvec3 along_s = glm::cross(t, n) / square, along_t = glm::cross(n, s) / square;
    const glm::dvec2 uv(primitive.texcoord[i[0]]);
    const glm::dvec2 ds = glm::dvec2(primitive.texcoord[i[1]]) - uv;
    const glm::dvec2 dt = glm::dvec2(primitive.texcoord[i[2]]) - uv;
    return glm::outerProduct(ds, along_s) + glm::outerProduct(dt, along_t);
}

UvMoments moments_of_area(const glm::dmat3x2& duv_dP, double area) {
    const glm::dmat2 squares = area * (duv_dP * glm::transpose(duv_dP));
    return {squares[0][0], squares[0][1], squares[1][1]};
}

UvMoments moments_of_edges(const glm::dmat3x2& duv_dP, const glm::dvec3& a, const glm::dvec3& b) {
    UvMoments moments;
    moments.add(duv_dP * a);
    moments.add(duv_dP * b);
    return moments;
}

UvMoments moments_of_cone(const glm::dmat3x2& duv_dP, const glm::dvec3& direction,
                          const glm::dvec3& normal, double distance, double solid_angle) {
    constexpr double kLeastCosine = 1e-4;
    const double width = distance * std::sqrt(solid_angle);
    const double cosine = glm::dot(direction, normal);
    const glm::dvec3 across = glm::cross(direction, normal);
    const double sine = glm::length(across);
    if (!(sine > 1e-6)) return moments_of_area(duv_dP, width * width);
    // Across the plane of incidence as wide as the cone, along it 1 / cosine longer.
    const glm::dvec3 along = (direction - cosine * normal) / sine;
    return moments_of_edges(duv_dP, width / sine * across,
                            width / std::max(std::abs(cosine), kLeastCosine) * along);
}

UvMoments moments_of_triangle(const std::array<glm::dvec2, 3>& uv) {
    const glm::dvec2 middle = (uv[0] + uv[1] + uv[2]) / 3.0;
    UvMoments moments;  // 12 times 1/12 of the squares of the corners' offsets
    for (const glm::dvec2& corner : uv) {
        moments.add(corner - middle);
    }
    return moments;
}

}  // namespace opaline::bake
