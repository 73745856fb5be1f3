#pragma once

#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// A trefoil, the torus knot (2, 3), as a tube that stands on two of its lobes and shows its three
/// to +Z. Lengths in millimetres.
struct KnotOptions {
    double height = 240.0;
    double sink = 0.4;     ///< depth of its lowest point below the floor
    unsigned along = 460;  ///< vertices along the tube, at least 3
    unsigned around = 56;  ///< vertices around it, at least 3
};

/// Closed and without twist: the rings turn evenly so that the last one meets the first.
TriangleMesh make_knot(const KnotOptions& options);

}  // namespace opaline::bake
