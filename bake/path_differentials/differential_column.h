#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// How the current vertex of a path moves with one of its random numbers x_j in [0, 1], or with a
/// sum of them that was merged.
struct DifferentialColumn {
    glm::dvec3 dP{0};  ///< of the vertex [m]
    glm::dvec3 dD{0};  ///< of the unit direction of propagation
    double dlnW = 0;   ///< relative change of the contribution
    /// Full length that x_j moves by; under global steps in units of the path's step.
    double step = 1;
};

}  // namespace opaline::bake
