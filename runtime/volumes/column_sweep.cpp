#include "runtime/volumes/column_sweep.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace opaline::runtime {
namespace {

using formats::kBrickSide;
using formats::kBrickVoxels;
using formats::kNoBrick;

// Of a code of density: sums over any table stay finite, and everything is opaque.
constexpr float kMostScale = 1e20f;
// Bricks that reach beyond a tile are added there, too, and not read.
constexpr std::int64_t kBeyond = kBrickSide;
constexpr std::size_t kWidth = kTile + 2 * kBeyond;

// 9 x 9 densities, those of the next bricks on the upper edges; u fastest.
constexpr std::size_t kPlaneSide = kBrickSide + 1;
using DensityPlane = std::array<float, kPlaneSide * kPlaneSide>;

constexpr std::array<std::size_t, 3> kVoxelStride{1, kBrickSide, kBrickSide* kBrickSide};

// A brick's layer of voxels, from 0 to 8, times `weight`.
DensityPlane density_plane(const VolumeLattice& lattice, const ColumnFrame& frame,
                           const BrickBlock& block, std::uint32_t layer, float weight) {
    DensityPlane plane{};
    const std::size_t above = layer == kBrickSide ? std::size_t{1} << frame.along : 0;
    const std::size_t su = kVoxelStride[frame.u], sv = kVoxelStride[frame.v];
    const auto add = [&](std::size_t neighbour, std::size_t first, std::size_t count_u,
                         std::size_t count_v) {
        const std::uint32_t brick = block.number[neighbour | above];
        if (brick == kNoBrick) return;
        const float scale = std::min(weight * lattice.density_scale[brick], kMostScale);
        const std::uint16_t* const code = lattice.density.data() + brick * kBrickVoxels +
                                          layer % kBrickSide * kVoxelStride[frame.along];
        for (std::size_t j = 0; j < count_v; ++j) {
            float* const row = plane.data() + first + j * kPlaneSide;
            for (std::size_t i = 0; i < count_u; ++i) {
                row[i] = scale * static_cast<float>(code[j * sv + i * su]);
            }
        }
    };
    const std::size_t next_u = std::size_t{1} << frame.u, next_v = std::size_t{1} << frame.v;
    add(0, 0, kBrickSide, kBrickSide);
    add(next_u, kBrickSide, 1, kBrickSide);
    add(next_v, kPlaneSide * kBrickSide, kBrickSide, 1);
    add(next_u | next_v, kPlaneSide * kBrickSide + kBrickSide, 1, 1);
    return plane;
}

// A tile on its way from the sun.
struct TileSweep {
    const SunColumns& volume;
    const ColumnFrame& frame;
    std::int64_t first_u, first_v;  // of its columns
    std::array<float, kWidth * kWidth> sum{};

    // Sums from column (u, v) on, counted from the tile's first one; both in [-8, 56).
    float* row(std::int64_t u, std::int64_t v) {
        return sum.data() + (static_cast<std::size_t>(v + kBeyond) * kWidth +
                             static_cast<std::size_t>(u + kBeyond));
    }
};

// Adds `weight` times the density of a brick in a layer of voxels to the columns that meet it
// there.
void add_plane(TileSweep& tile, const BrickBlock& block, std::uint32_t layer, float weight) {
    const ColumnFrame& frame = tile.frame;
    const double along = static_cast<double>(kBrickSide) * block.cell[frame.along] + layer;
    const Lean lean_u = lean_at(frame.slope_u, along), lean_v = lean_at(frame.slope_v, along);
    const std::int64_t u =
        std::int64_t{kBrickSide} * block.cell[frame.u] - lean_u.whole - tile.first_u;
    const std::int64_t v =
        std::int64_t{kBrickSide} * block.cell[frame.v] - lean_v.whole - tile.first_v;
    if (u <= -kBeyond || v <= -kBeyond || u > kTile || v > kTile) return;
    const DensityPlane plane = density_plane(tile.volume.lattice, frame, block, layer, weight);
    std::array<float, kPlaneSide * kBrickSide> mixed;
    for (std::size_t j = 0; j < kPlaneSide; ++j) {
        const float* const from = plane.data() + j * kPlaneSide;
        for (std::size_t i = 0; i < kBrickSide; ++i) {
            mixed[j * kBrickSide + i] = from[i] + lean_u.part * (from[i + 1] - from[i]);
        }
    }
    for (std::size_t j = 0; j < kBrickSide; ++j) {
        const float* const low = mixed.data() + j * kBrickSide;
        float* const to = tile.row(u, v + static_cast<std::int64_t>(j));
        for (std::size_t i = 0; i < kBrickSide; ++i) {
            to[i] += low[i] + lean_v.part * (low[kBrickSide + i] - low[i]);
        }
    }
}

// Sets the columns of a brick's own points in a layer of them.
void read_points(TileSweep& tile, const BrickBlock& block, std::uint32_t layer,
                 std::span<float> column) {
    const ColumnFrame& frame = tile.frame;
    const std::uint32_t boxes = tile.volume.boxes(), apart = kBrickSide / boxes;
    const std::size_t side = boxes + 1;
    const std::array<std::size_t, 3> stride{1, side, side * side};
    const double along = static_cast<double>(kBrickSide) * block.cell[frame.along] +
                         static_cast<double>(layer * apart);
    const Lean lean_u = lean_at(frame.slope_u, along), lean_v = lean_at(frame.slope_v, along);
    // Between this column and the next one.
    const std::int64_t u =
        std::int64_t{kBrickSide} * block.cell[frame.u] - lean_u.whole - 1 - tile.first_u;
    const std::int64_t v =
        std::int64_t{kBrickSide} * block.cell[frame.v] - lean_v.whole - 1 - tile.first_v;
    const auto metres = static_cast<float>(frame.metres);
    const std::size_t above = layer == boxes ? std::size_t{1} << frame.along : 0;
    for (std::uint32_t j = 0; j <= boxes; ++j) {
        const std::int64_t at_v = v + j * apart;
        if (at_v < 0 || at_v >= kTile) continue;
        for (std::uint32_t i = 0; i <= boxes; ++i) {
            const std::int64_t at_u = u + i * apart;
            if (at_u < 0 || at_u >= kTile) continue;
            const std::size_t neighbour = above | (i == boxes ? std::size_t{1} << frame.u : 0) |
                                          (j == boxes ? std::size_t{1} << frame.v : 0);
            const std::uint32_t owner = block.number[neighbour];
            if (owner != block.number[0] && owner != kNoBrick) continue;
            const float* const s = tile.row(at_u, at_v);
            const float low = s[1] + lean_u.part * (s[0] - s[1]);
            const float high = s[kWidth + 1] + lean_u.part * (s[kWidth] - s[kWidth + 1]);
            column[layer * stride[frame.along] + i * stride[frame.u] + j * stride[frame.v]] =
                metres * (high + lean_v.part * (low - high));
        }
    }
}

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

void sweep_tile(const SunColumns& volume, const ColumnFrame& frame,
                std::span<const TileBrick> bricks, std::span<float> column) {
    TileSweep tile{volume, frame, kTile * bricks[0].tile_u, kTile * bricks[0].tile_v};
    const std::uint32_t apart = kBrickSide / volume.boxes();
    std::vector<BrickBlock> blocks;
    for (std::size_t first = 0, end = 0; first < bricks.size(); first = end) {
        blocks.clear();
        for (; end < bricks.size() && bricks[end].turn == bricks[first].turn; ++end) {
            blocks.push_back(brick_block(volume.lattice, volume.cell(bricks[end].brick)));
        }
        // The trapezoidal rule: of layers where it begins, ends or is read, half comes before.
        for (std::uint32_t step = 0; step <= kBrickSide; ++step) {
            const std::uint32_t layer = frame.ascends ? kBrickSide - step : step;
            const bool has_points = layer % apart == 0;
            const auto add = [&](float weight) {
                for (const BrickBlock& block : blocks) {
                    add_plane(tile, block, layer, weight);
                }
            };
            if (step > 0) add(has_points ? 0.5f : 1.0f);
            if (!has_points) continue;
            for (const BrickBlock& block : blocks) {
                read_points(tile, block, layer / apart,
                            column.subspan(block.number[0] * volume.points(), volume.points()));
            }
            if (step < kBrickSide) add(0.5f);
        }
    }
}

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
