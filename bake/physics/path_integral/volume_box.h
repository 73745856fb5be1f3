#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <limits>

namespace opaline::bake {

/// What a medium does to light at one point, for one band. The functions of this room take a medium
/// as any callable `Coefficients medium(glm::dvec3 position)`, finite everywhere.
struct Coefficients {
    double scattering = 0;  ///< b [1/m], >= 0
    double absorption = 0;  ///< a [1/m], >= 0

    double extinction() const { return scattering + absorption; }  ///< c [1/m]
};

/// A box with faces perpendicular to the axes [m]; its faces belong to it.
struct VolumeBox {
    glm::dvec3 low{0}, high{0};

    bool contains(glm::dvec3 x) const {
        return x.x >= low.x && x.y >= low.y && x.z >= low.z && x.x <= high.x && x.y <= high.y &&
               x.z <= high.z;
    }
};

/// Distance [m] from `x` in the box along the unit vector `direction` to where the ray leaves it,
/// >= 0; 0 from a face outward. Finite if the box is.
inline double exit_distance(const VolumeBox& box, glm::dvec3 x, glm::dvec3 direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        // A ray parallel to two faces never meets them: 0 / 0 on the face itself.
        if (direction[axis] != 0) {
            const double face = direction[axis] > 0 ? box.high[axis] : box.low[axis];
            nearest = std::min(nearest, (face - x[axis]) / direction[axis]);
        }
    }
    return std::max(nearest, 0.0);
}

}  // namespace opaline::bake
