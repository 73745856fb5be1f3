#include "runtime/lobe_cells.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/cubemap.h"

namespace opaline::runtime {
namespace {

using formats::Vec3;

std::vector<Reach> reaches(std::size_t levels, float alpha_squared) {
    std::vector<Reach> of_level(levels);
    for (std::size_t level = 0; level < levels; ++level) {
        const float radius = 1.42f / static_cast<float>(1u << level);  // half the diagonal
        of_level[level].lit = std::sqrt(2 * (1 + radius));
        if (level + 1 == levels) continue;  // texels stay whole
        const float room = 2 * radius * radius - alpha_squared;
        if (room > 0) of_level[level].divided = 2 * std::sqrt(room);
        if (level < 3 && alpha_squared > 0.05f) of_level[level].divided = 4;
    }
    return of_level;
}

}  // namespace

LobeTree make_lobe_tree(const LightQuadtree& tree) {
    LobeTree lobes;
    for (const LightCell& face : tree.level.front()) {
        lobes.total += std::abs(face.flux[0]) + std::abs(face.flux[1]) + std::abs(face.flux[2]);
    }
    const double share = lobes.total > 0 ? 1 / lobes.total : 0;
    for (const std::vector<LightCell>& cells : tree.level) {
        std::vector<LobeCell>& out = lobes.level.emplace_back();
        out.reserve(cells.size());
        for (const LightCell& c : cells) {
            out.push_back(
                {c.centre,
                 c.flux_centre,
                 c.solid_angle,
                 {static_cast<float>(share * c.flux[0]), static_cast<float>(share * c.flux[1]),
                  static_cast<float>(share * c.flux[2])}});
        }
    }
    return lobes;
}

DirectionTile make_tile(std::uint32_t size, std::uint32_t face, std::uint32_t row,
                        std::uint32_t column) {
    DirectionTile tile;
    std::array<Vec3, 8> direction;
    Vec3 sum{0, 0, 0};
    for (std::uint32_t k = 0; k < 8; ++k) {
        const Vec3 d =
            formats::texel_direction(size, face, row + k / kTileWidth, column + k % kTileWidth);
        direction[k] = d;
        tile.x[k] = d.x;
        tile.y[k] = d.y;
        tile.z[k] = d.z;
        sum = sum + d;
    }
    tile.centre = normalize(sum);
    for (const Vec3 d : direction) {
        tile.radius = std::max(tile.radius, length(d - tile.centre));
    }
    return tile;
}

BlockCells::BlockCells(const LobeTree& tree, float alpha_squared)
    : tree_(tree), reach_(reaches(tree.level.size(), alpha_squared)), square_(reach_.size()) {}

void BlockCells::move_to(const std::array<DirectionTile, 8>& tiles) {
    for (std::size_t t = 0; t < 8; ++t) {
        x_[t / 4][t % 4] = tiles[t].centre.x;
        y_[t / 4][t % 4] = tiles[t].centre.y;
        z_[t / 4][t % 4] = tiles[t].centre.z;
        for (std::size_t level = 0; level < reach_.size(); ++level) {
            const float near = reach_[level].divided + tiles[t].radius;
            const float far = reach_[level].lit + tiles[t].radius;
            square_[level].divided[t / 4][t % 4] = near * std::abs(near);
            square_[level].lit[t / 4][t % 4] = far * far;
        }
    }
    common_.clear();
    others_.clear();
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        stack_[waiting_++] = {0, face, 0, kAll};
    }
    while (waiting_ > 0) {
        follow(stack_[--waiting_]);
    }
}

std::span<const LobeCell* const> BlockCells::own(std::uint32_t tile) {
    own_.resize(others_.size());
    std::size_t count = 0;
    for (const auto& [cell, tiles] : others_) {
        own_[count] = cell;  // overwritten by the next one if the tile does not add it
        count += tiles >> tile & 1;
    }
    return std::span(own_).first(count);
}

void BlockCells::follow(Node n) {
    const LobeCell& cell = tree_.level[n.level][(std::size_t{n.row} << n.level) + n.column];
    const Squares& of = square_[n.level];
    // A bit for each tile: in the lower eight of those that it lights, in the next of those near
    // it.
    Int4 bits{};
    for (std::uint32_t half = 0; half < 2; ++half) {
        const Float4 x = x_[half] - cell.centre.x, y = y_[half] - cell.centre.y,
                     z = z_[half] - cell.centre.z, squared = x * x + y * y + z * z;
        const Int4 number = Int4{1, 2, 4, 8} << static_cast<std::int32_t>(4 * half);
        bits |=
            ((squared <= of.lit[half]) & number) | ((squared < of.divided[half]) & (number << 8));
    }
    bits |= __builtin_shufflevector(bits, bits, 2, 3, 0, 1);
    bits |= __builtin_shufflevector(bits, bits, 1, 0, 3, 2);
    const auto all = static_cast<std::uint32_t>(bits[0]);
    const std::uint32_t lit = all & n.tiles, near = all >> 8;
    const std::uint32_t divide = lit & near;
    if (divide != 0) {
        for (const std::uint32_t i : {0u, 1u, 2u, 3u}) {
            stack_[waiting_++] = {n.level + 1, 2 * n.row + i / 2, 2 * n.column + i % 2, divide};
        }
    }
    const std::uint32_t add = lit & ~near;
    if (add == kAll) {
        common_.push_back(&cell);
    } else if (add != 0) {
        others_.push_back({&cell, add});
    }
}

}  // namespace opaline::runtime
