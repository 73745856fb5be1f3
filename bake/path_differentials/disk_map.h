#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// How two random numbers become a point of the unit disk, uniform over its area.
enum class DiskMap {
    polar,      ///< radius sqrt(v), azimuth 2 pi u
    concentric  ///< squares around the middle become circles: no derivative diverges there
};

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

/// u, v in [0, 1]; v > 0 in the polar map, whose radial derivative 1 / (2 sqrt v) is infinite in
/// the middle. The columns of the concentric map jump on the diagonals; the area that they span is
/// pi everywhere.
DiskPoint map_to_disk(DiskMap map, double u, double v);

}  // namespace opaline::bake
