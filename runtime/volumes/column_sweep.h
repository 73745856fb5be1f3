#pragma once

#include <span>

#include "runtime/volumes/column_tiles.h"

namespace opaline::runtime {

/// Sets the columns of the points of bricks that lie in one tile. Each point lies in one tile.
void sweep_tile(const SunColumns& volume, const ColumnFrame& frame,
                std::span<const TileBrick> bricks, std::span<float> column);

}  // namespace opaline::runtime
