#include "runtime/volumes/column_tiles.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace opaline::runtime {
namespace {

using formats::kBrickSide;

constexpr std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
    return a / b - (a % b < 0 ? 1 : 0);
}

struct TileRange {
    std::int64_t first, last;
};

// Tiles that have to do with a brick `across` from the table's corner, `along` from its floor.
TileRange tiles_across(double slope, std::int64_t across, std::int64_t along) {
    const auto floor = lean_at(slope, static_cast<double>(kBrickSide * along)).whole;
    const auto ceiling = lean_at(slope, static_cast<double>(kBrickSide * (along + 1))).whole;
    const std::int64_t first = kBrickSide * across - std::max(floor, ceiling) - 1;
    const std::int64_t last = kBrickSide * (across + 1) - std::min(floor, ceiling);
    // A tile's points read one column more than it has.
    return {floor_divide(first - 1, kTile), floor_divide(last, kTile)};
}

}  // namespace

std::optional<ColumnFrame> make_column_frame(const VolumeLattice& lattice, formats::Vec3 sun) {
    const std::array<double, 3> d = index_of_direction(lattice, sun);
    ColumnFrame frame;
    for (std::size_t a = 1; a < 3; ++a) {
        if (std::abs(d[a]) > std::abs(d[frame.along])) frame.along = a;
    }
    const double most = d[frame.along];
    if (most == 0 || !std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2])) {
        return std::nullopt;
    }
    frame.u = frame.along == 0 ? 1 : 0;
    frame.v = frame.along == 2 ? 1 : 2;
    frame.slope_u = d[frame.u] / most;
    frame.slope_v = d[frame.v] / most;
    frame.metres = 1 / std::abs(most);
    frame.ascends = most > 0;
    return frame;
}

std::vector<TileBrick> list_tiles(const SunColumns& volume, const ColumnFrame& frame) {
    std::vector<TileBrick> list;
    const auto count = static_cast<std::uint32_t>(volume.cell_of_brick.size());
    const std::uint32_t layers = volume.lattice.record->extent[frame.along];
    list.reserve(2 * count);
    for (std::uint32_t brick = 0; brick < count; ++brick) {
        const std::array<std::int32_t, 3> cell = volume.cell(brick);
        if (volume.lattice.brick(cell) != brick) continue;
        const auto layer = static_cast<std::uint32_t>(cell[frame.along]);
        const TileRange us = tiles_across(frame.slope_u, cell[frame.u], layer);
        const TileRange vs = tiles_across(frame.slope_v, cell[frame.v], layer);
        for (std::int64_t v = vs.first; v <= vs.last; ++v) {
            for (std::int64_t u = us.first; u <= us.last; ++u) {
                list.push_back({static_cast<std::int32_t>(u), static_cast<std::int32_t>(v),
                                frame.ascends ? layers - 1 - layer : layer, brick});
            }
        }
    }
    std::ranges::sort(list, {}, [](const TileBrick& b) {
        return std::tuple(b.tile_v, b.tile_u, b.turn, b.brick);
    });
    return list;
}

}  // namespace opaline::runtime
