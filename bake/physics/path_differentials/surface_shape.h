#pragma once

#include <array>
#include <glm/glm.hpp>

namespace opaline::bake {

/// A surface around a point, to first order. Where the normal is turned to face a ray, so is dN_dP:
/// see `flipped`.
struct SurfaceShape {
    glm::dvec3 N{0, 0, 1};  ///< shading normal, unit
    glm::dmat3 dN_dP{0.0};  ///< change of N per change of the point in its tangent plane [1/m]
};

/// At a point P of a triangle with unit normals at its corners, whose barycentric mean m is not 0:
/// N = m / |m|, dN = (dm - N (N.dm)) / |m|. A triangle without area (n.n < 1e-24 edge^4) is flat,
/// and its middle the point.
SurfaceShape interpolated_shape(const std::array<glm::dvec3, 3>& corners,
                                const std::array<glm::dvec3, 3>& normals, const glm::dvec3& P);

/// The same from the other side.
inline SurfaceShape flipped(const SurfaceShape& shape) {
    return {-shape.N, -shape.dN_dP};
}

}  // namespace opaline::bake
