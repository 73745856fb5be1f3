#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// Reflection and transmission of a ray at a smooth dielectric boundary.
struct BoundarySplit {
    float reflectance = 0;     ///< unpolarised Fresnel reflectance in [0, 1]; 1: total reflection
    glm::vec3 reflected{0};    ///< unit
    glm::vec3 transmitted{0};  ///< unit; unset under total reflection
};

/// `direction`: unit, of propagation, toward the boundary. `normal`: unit, against the direction:
/// dot(direction, normal) < 0. `ratio`: index of refraction beyond over index on this side, > 0.
BoundarySplit split_at_boundary(glm::vec3 direction, glm::vec3 normal, float ratio);

/// An interpolated normal where it fits the ray. Where it faces away or reflects to behind the
/// triangle, it is turned toward the triangle's own normal until it does not: as little as needed,
/// so that the reflected ray has no jump where that begins. Both normals point away from the same
/// side; the triangle's normal is against the direction.
glm::vec3 fitting_normal(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat);

/// The split at the normal that fits. A ray that it refracts to in front of the triangle is
/// reflected totally: from the denser side such a normal lies close to the critical angle.
BoundarySplit split_at_smooth_boundary(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat,
                                       float ratio);

}  // namespace opaline::bake
