#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace opaline::bake {

/// A right-handed orthonormal frame; `normal` is its third axis.
struct Frame {
    glm::vec3 u, v, normal;

    glm::vec3 to_world(glm::vec3 d) const { return d.x * u + d.y * v + d.z * normal; }
};

/// The frame around a unit vector [Duff2017]: no branch, no singularity.
inline Frame make_frame(glm::vec3 n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    return {
        {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace opaline::bake
