#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {

/// A ray on its way through the table of a volume, brick after brick [AmanatidesWoo1987].
/// Coordinates in bricks, from the table's lowest corner: p(t) = origin + t direction, t the
/// distance in the world [m].
struct BrickWalk {
    std::array<double, 3> origin{}, direction{};
    std::array<std::int32_t, 3> cell{};
    double t = 0, end = 0;  ///< rest of the ray; empty if t >= end
};

/// A part of the ray within one brick that exists; begin < end, both finite.
struct BrickSpan {
    double begin = 0, end = 0;
    std::array<std::int32_t, 3> cell{};
};

/// The walk of the ray between the distances `begin` and `end`, cut to the table. Nothing to walk
/// where they do not meet, or where one of origin and direction is not finite or the direction is
/// zero.
BrickWalk start_walk(const VolumeLattice& lattice, formats::Vec3 origin, formats::Vec3 direction,
                     double begin, double end);

/// The next brick, and the walk moved past it. Visits each layer of the table at most once along
/// each axis, so that a whole walk takes at most extent.x + extent.y + extent.z steps.
std::optional<BrickSpan> next_brick(const VolumeLattice& lattice, BrickWalk& walk);

}  // namespace opaline::runtime
