#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// How a point of the disk moves with one random number.
struct DiskColumn {
    double dq = 0;          ///< change of the squared radius
    double radial = 0;      ///< along `outward`
    double tangential = 0;  ///< along `outward` turned by +90 degrees
};

/// A point of the unit disk and its derivatives.
struct DiskPoint {
    double q = 0, radius = 0;  ///< q = radius^2 in [0, 1]
    glm::dvec2 outward{1, 0};  ///< unit
    DiskColumn du, dv;
};

/// Uniform over the disk's area: squares around the middle become circles, so that no derivative
/// diverges there. u, v in [0, 1]. Columns jump on the diagonals; the area that they span is pi
/// everywhere.
DiskPoint map_to_disk(double u, double v);

}  // namespace opaline::bake
