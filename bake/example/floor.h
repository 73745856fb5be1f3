#pragma once

#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// A square floor at y = 0, facing up.
struct FloorOptions {
    double finest = 1.8;        ///< cell under and around the object [mm]
    double fine_radius = 55.0;  ///< of the disc about the origin with that cell [mm]
    double growth = 0.1;        ///< cell size per distance beyond the disc, at most 0.15
    unsigned levels = 9;        ///< the floor is 2^levels finest cells wide
};

/// Squares that double in size away from the middle, as right-angled triangles of 45 degrees
/// without hanging corners: shadows stay sharp at the object's foot for few vertices.
TriangleMesh make_floor(const FloorOptions& options);

}  // namespace opaline::bake
