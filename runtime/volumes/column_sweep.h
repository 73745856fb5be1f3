#pragma once

#include <span>

#include "runtime/volumes/column_tiles.h"

namespace opaline::runtime {

/// Sets the columns of those points of the bricks of one tile that stand in it: each point stands
/// in one tile.
void sweep_tile(const SunColumns& volume, const ColumnFrame& frame,
                std::span<const TileBrick> bricks, std::span<float> column);

}  // namespace opaline::runtime
