#include "runtime/volumes/sun_point.h"

#include <algorithm>
#include <cmath>

#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::kBrickSide;
using formats::kNoBrick;
using formats::Rgb;

constexpr float kMost = 1e6f;  // of a sum that lowers light; NaN lowers nothing

// Whether a point without a next brick is on an edge. Bricks that meet there have different
// neighbours, and must agree on its value.
bool is_common(const std::array<std::uint32_t, 3>& place, std::uint32_t boxes) {
    const auto on_faces =
        std::ranges::count_if(place, [&](std::uint32_t x) { return x % boxes == 0; });
    return on_faces > 1 && std::ranges::count(place, boxes) > 0;
}

// Those next to a point along each axis, lower ones first.
std::array<std::size_t, 6> find_next(const SunColumns& volume, const BrickSurroundings& around,
                                     const std::array<std::uint32_t, 3>& place,
                                     std::size_t column) {
    const std::uint32_t boxes = volume.boxes();
    std::array<std::size_t, 6> next{};
    std::size_t stride = 1;
    for (std::size_t a = 0; a < 3; ++a, stride *= boxes + 1) {
        next[2 * a + 1] = place[a] < boxes ? column + stride : kNoPoint;
        if (place[a] > 0) {
            next[2 * a] = column - stride;
        } else if (around.below[a] != kNoBrick) {
            const std::size_t in_brick = column - around.brick * volume.points();
            next[2 * a] = around.below[a] * volume.points() + in_brick + (boxes - 1) * stride;
        } else {
            next[2 * a] = kNoPoint;
        }
    }
    return next;
}

// Of depths in eight lanes, for vector units; the last two are 0.
using Rises = std::array<float, 8>;

float lowering(const Rises& way, float extinction) {
    Rises over{};
    for (std::size_t i = 0; i < way.size(); ++i) {
        const float x = extinction * way[i];
        const float size = 1 + std::abs(x) + 0.5f * x * x, inverse = 1 / size;
        over[i] = (x > 0 ? size : inverse) - 1;
    }
    float sum = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        sum += over[i];
    }
    return 1 / (1 + tame(sum / 12, kMost));
}

}  // namespace

BrickSurroundings brick_surroundings(const SunColumns& volume, std::uint32_t brick) {
    const std::array<std::int32_t, 3> cell = volume.cell(brick);
    BrickSurroundings around{brick, brick_block(volume.lattice, cell), {}};
    for (std::size_t a = 0; a < 3; ++a) {
        std::array<std::int32_t, 3> below = cell;
        --below[a];
        around.below[a] = volume.lattice.brick(below);
    }
    return around;
}

SunPoint make_sun_point(const SunColumns& volume, const BrickSurroundings& around,
                        const std::array<std::uint32_t, 3>& place) {
    const formats::VolumeRecord& record = *volume.lattice.record;
    const std::uint32_t boxes = volume.boxes();
    const float apart = static_cast<float>(kBrickSide) / static_cast<float>(boxes);
    const auto& m = record.to_world;
    std::array<float, 3> at{}, index{};
    for (std::size_t a = 0; a < 3; ++a) {
        at[a] = static_cast<float>(place[a]) * apart;
        index[a] =
            static_cast<float>(kBrickSide * (record.first_brick[a] + around.block.cell[a])) + at[a];
    }
    const auto world = [&](std::size_t row) {
        return m[row] * index[0] + m[row + 1] * index[1] + m[row + 2] * index[2] + m[row + 3];
    };
    const std::size_t side = boxes + 1;
    SunPoint point;
    point.column = around.brick * volume.points() + (place[2] * side + place[1]) * side + place[0];
    point.next.fill(kNoPoint);
    if (!is_common(place, boxes)) {
        point.next = find_next(volume, around, place, point.column);
    }
    point.world = {world(0), world(4), world(8)};
    const NodeCell box = node_cell(volume.lattice, at);
    point.node = nodes_of_cell(volume.lattice, around.brick, box.number);
    point.weight = corner_weights(box.weight);
    float whole = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        if (point.node[i] == formats::kNoNode) point.weight[i] = 0;
        whole += point.weight[i];
    }
    for (float& weight : point.weight) {
        weight *= whole > 0 ? 1 / whole : 0;
    }
    return point;
}

Rgb find_lowering(const SunPoint& point, std::span<const float> column, Rgb sigma_t, float power) {
    Rises way{};
    for (std::size_t i = 0; i < point.next.size(); ++i) {
        if (point.next[i] != kNoPoint) way[i] = column[point.column] - column[point.next[i]];
    }
    const float red = lowering(way, power * sigma_t.r);
    if (sigma_t.r == sigma_t.g && sigma_t.g == sigma_t.b) return {red, red, red};
    return {red, lowering(way, power * sigma_t.g), lowering(way, power * sigma_t.b)};
}

}  // namespace opaline::runtime
