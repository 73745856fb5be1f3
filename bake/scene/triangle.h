#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

#include "formats/scene.h"

namespace opaline::bake {

/// Unit normal of a triangle of `p`, by its winding, computed in double precision so that slivers
/// keep their direction; {0,0,0} without area.
inline glm::vec3 triangle_normal(const formats::Primitive& p, std::size_t triangle) {
    const glm::dvec3 a = p.position[p.index[3 * triangle]];
    const glm::dvec3 b = p.position[p.index[3 * triangle + 1]];
    const glm::dvec3 c = p.position[p.index[3 * triangle + 2]];
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    return length > 0 ? glm::vec3(n / length) : glm::vec3(0);
}

/// Distance of the segment a, b from the origin. Precondition: a != b.
inline double distance_to_segment(glm::dvec3 a, glm::dvec3 b) {
    const glm::dvec3 ab = b - a;
    const double t = std::clamp(-glm::dot(a, ab) / glm::dot(ab, ab), 0.0, 1.0);
    return glm::length(a + t * ab);
}

/// Distance of the triangle a, b, c from the origin. Precondition: its area is not 0.
inline double distance_to_triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const bool is_over = glm::dot(glm::cross(b - a, n), a) >= 0 &&
                         glm::dot(glm::cross(c - b, n), b) >= 0 &&
                         glm::dot(glm::cross(a - c, n), c) >= 0;
    if (is_over) return std::abs(glm::dot(n, a)) / glm::length(n);
    return std::min(
        {distance_to_segment(a, b), distance_to_segment(b, c), distance_to_segment(c, a)});
}

}  // namespace opaline::bake
