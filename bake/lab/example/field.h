#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>

namespace opaline::bake {

/// An implicit solid: negative inside, zero on the surface, positive outside, close to the signed
/// distance [mm] near the surface. Called from several threads at once.
using ScalarField = std::function<double(const glm::dvec3&)>;

/// Axis-aligned box, low <= high in each axis.
struct Box {
    glm::dvec3 low{0.0}, high{0.0};
};

/// Union of two solids whose seam is filleted over `width` [mm] > 0. Twice differentiable, so that
/// highlights run smoothly over the seam; exactly min(a, b) where |a - b| >= width.
inline double smooth_union(double a, double b, double width) {
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - h * h * h * width / 6.0;
}

/// Intersection filleted in the same way.
inline double smooth_intersection(double a, double b, double width) {
    return -smooth_union(-a, -b, width);
}

/// Ellipsoid about the origin; exact to first order at its surface. Every radius > 0.
inline double ellipsoid(const glm::dvec3& p, const glm::dvec3& radii) {
    const double scaled = glm::length(p / radii);
    const double slope = glm::length(p / (radii * radii));
    return slope > 1e-12 ? scaled * (scaled - 1.0) / slope : -std::min({radii.x, radii.y, radii.z});
}

/// Direction of steepest increase of the field, not normalised, by differences over `step` [mm].
inline glm::dvec3 gradient(const ScalarField& field, const glm::dvec3& p, double step) {
    // Four samples at the corners of a tetrahedron: as accurate to first order as six on the axes.
    constexpr glm::dvec3 kCorners[] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& corner : kCorners) {
        sum += corner * field(p + step * corner);
    }
    return sum / (4.0 * step);
}

}  // namespace opaline::bake
