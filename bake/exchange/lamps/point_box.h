#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "formats/scene.h"

namespace opaline::bake {

/// The box around some points [m]; none: low is infinite, and high its negative.
struct PointBox {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void include(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    glm::dvec3 centre() const { return 0.5 * (low + high); }
    /// Of the ball around it.
    double radius() const { return 0.5 * glm::length(high - low); }
};

/// Around all surfaces.
inline PointBox box_of_surfaces(const formats::Scene& scene) {
    PointBox box;
    for (const formats::Primitive& primitive : scene.primitives) {
        for (const glm::vec3& position : primitive.position) {
            box.include(glm::dvec3(position));
        }
    }
    return box;
}

}  // namespace opaline::bake
