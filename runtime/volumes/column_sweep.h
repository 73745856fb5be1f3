#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"
#include "runtime/volumes/sun_columns.h"

namespace opaline::runtime {

/// How the columns of a volume lean toward a sun (sun_columns.h).
struct ColumnFrame {
    std::size_t along = 0, u = 0, v = 0;  ///< the axis that the sun is nearest to, and the others
    double slope_u = 0, slope_v = 0;      ///< voxels across for each along; in [-1, 1]
    double metres = 0;                    ///< of way for each voxel along
    bool ascends = true;                  ///< toward the sun
};

/// Nothing where the direction is not one in the volume.
std::optional<ColumnFrame> make_column_frame(const VolumeLattice& lattice, formats::Vec3 sun);

/// How far columns have leant at a height.
struct Lean {
    std::int64_t whole = 0;
    float part = 0;  ///< [0, 1)
};
/// `height` in voxels from the table's floor.
inline Lean lean_at(double slope, double height) {
    const double all = slope * height, whole = std::floor(all);
    return {static_cast<std::int64_t>(whole), static_cast<float>(all - whole)};
}

inline constexpr std::int64_t kTile = 48;  ///< columns along a tile's edge

/// Columns are found in square tiles, each apart. A brick that a tile needs:
struct TileBrick {
    std::int32_t tile_u = 0, tile_v = 0;
    std::uint32_t turn = 0;  ///< its layer of bricks along the axis, counted from the sun
    std::uint32_t brick = 0;
};
constexpr bool is_same_tile(const TileBrick& a, const TileBrick& b) {
    return a.tile_u == b.tile_u && a.tile_v == b.tile_v;
}

/// All of a volume, tile after tile, in each by turn. Bricks without a cell are left out.
std::vector<TileBrick> list_tiles(const SunColumns& volume, const ColumnFrame& frame);

/// Sets the columns of the points of bricks that lie in one tile. Each point lies in one tile.
void sweep_tile(const SunColumns& volume, const ColumnFrame& frame,
                std::span<const TileBrick> bricks, std::span<float> column);

}  // namespace opaline::runtime
