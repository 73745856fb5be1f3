#pragma once

#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

/// A rosette of arched leaves around a common foot at the origin, as surfaces without an inside:
/// upper side outward. Lengths in millimetres.
struct LeavesOptions {
    unsigned leaves = 11;
    unsigned along = 40, across = 16;  ///< cells of a leaf, each at least 2
};

TriangleMesh make_leaves(const LeavesOptions& options);

}  // namespace opaline::bake
