#include "runtime/volumes/brick_walk.h"

#include <algorithm>
#include <cmath>

namespace opaline::runtime {

using formats::kBrickSide;

BrickWalk start_walk(const VolumeLattice& lattice, formats::Vec3 origin, formats::Vec3 direction,
                     double begin, double end) {
    BrickWalk walk;
    walk.origin = index_of_point(lattice, origin);
    walk.direction = index_of_direction(lattice, direction);
    bool moves = false, is_finite = !std::isnan(begin) && !std::isnan(end);
    for (std::size_t a = 0; a < 3; ++a) {
        walk.origin[a] = walk.origin[a] / kBrickSide - lattice.record->first_brick[a];
        walk.direction[a] /= kBrickSide;
        is_finite = is_finite && std::isfinite(walk.origin[a]) && std::isfinite(walk.direction[a]);
        moves = moves || walk.direction[a] != 0;
    }
    if (!is_finite || !moves) return walk;
    // Cut to the slabs between the table's faces.
    for (std::size_t a = 0; a < 3; ++a) {
        const double extent = lattice.record->extent[a];
        if (walk.direction[a] == 0) {
            if (walk.origin[a] < 0 || walk.origin[a] > extent) return walk;
            continue;
        }
        const double low = -walk.origin[a] / walk.direction[a];
        const double high = (extent - walk.origin[a]) / walk.direction[a];
        begin = std::max(begin, std::min(low, high));
        end = std::min(end, std::max(low, high));
    }
    if (!(begin < end) || !std::isfinite(begin) || !std::isfinite(end)) return walk;
    walk.t = begin;
    walk.end = end;
    for (std::size_t a = 0; a < 3; ++a) {
        const double at = walk.origin[a] + begin * walk.direction[a];
        const double last = static_cast<double>(lattice.record->extent[a]) - 1;
        if (!std::isfinite(at)) {
            walk.end = walk.t;
            return walk;
        }
        walk.cell[a] = static_cast<std::int32_t>(std::clamp(std::floor(at), 0.0, last));
    }
    return walk;
}

std::optional<BrickSpan> next_brick(const VolumeLattice& lattice, BrickWalk& walk) {
    while (walk.t < walk.end) {
        // The face through which the ray leaves this cell.
        double leaves = HUGE_VAL;
        std::size_t axis = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            if (walk.direction[a] == 0) continue;
            const double face = walk.cell[a] + (walk.direction[a] > 0 ? 1.0 : 0.0);
            const double t = (face - walk.origin[a]) / walk.direction[a];
            if (t < leaves) {
                leaves = t;
                axis = a;
            }
        }
        const BrickSpan span{walk.t, std::min(leaves, walk.end), walk.cell};
        walk.t = std::max(walk.t, span.end);
        walk.cell[axis] += walk.direction[axis] > 0 ? 1 : -1;
        if (walk.cell[axis] < 0 ||
            static_cast<std::uint32_t>(walk.cell[axis]) >= lattice.record->extent[axis]) {
            walk.end = walk.t;
        }
        if (span.begin < span.end && lattice.brick(span.cell) != formats::kNoBrick) return span;
    }
    return std::nullopt;
}

}  // namespace opaline::runtime
