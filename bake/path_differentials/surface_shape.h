#pragma once

#include <array>
#include <glm/glm.hpp>

namespace opaline::bake {

/// A surface around a point, to first order. Where the normal is turned to face a ray, so is dN_dP:
/// see `flipped`.
struct SurfaceShape {
    glm::dvec3 N{0, 0, 1};     ///< shading normal, unit
    glm::dmat3 dN_dP{0.0};     ///< change of N per change of the point in its tangent plane [1/m]
    glm::dmat3x2 duv_dP{0.0};  ///< of the texture coordinates [1/m]
};

/// Barycentric coordinates of a triangle as linear functions of position.
struct TriangleGradients {
    std::array<glm::dvec3, 3> gradient{};  ///< of each coordinate [1/m]; they sum to 0
    glm::dvec3 bary{1.0 / 3};              ///< at the point
};

/// A triangle without area (n.n < 1e-24 edge^4) has no gradients, and its middle as the point.
TriangleGradients triangle_gradients(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& P);

/// Unit normals and texture coordinates at three corners.
struct TriangleAttributes {
    std::array<glm::dvec3, 3> normal{};
    std::array<glm::dvec2, 3> uv{};
};

/// m = a N_A + b N_B + c N_C, N = m / |m|, dN = (dm - N (N.dm)) / |m|. Precondition: m != 0.
SurfaceShape interpolated_shape(const TriangleGradients& at, const TriangleAttributes& attributes);

/// A sphere of radius r around the centre, outward normal: dN = dP / r.
SurfaceShape sphere_shape(const glm::dvec3& center, double radius, const glm::dvec3& P);

/// The same from the other side.
inline SurfaceShape flipped(const SurfaceShape& shape) {
    return {-shape.N, -shape.dN_dP, shape.duv_dP};
}

}  // namespace opaline::bake
