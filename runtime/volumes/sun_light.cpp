#include "runtime/volumes/sun_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/parallel.h"
#include "runtime/volumes/sun_columns.h"
#include "runtime/volumes/volume_lattice.h"
#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::kBrickSide;
using formats::kNoBrick;
using formats::Rgb;

inline constexpr std::size_t kNoPoint = static_cast<std::size_t>(-1);

// A brick, and those below it along each axis, or kNoBrick.
struct BrickSurroundings {
    std::uint32_t brick = 0;
    BrickBlock block;
    std::array<std::uint32_t, 3> below{};
};

// A point of suns, the nodes around it and the points next to it.
struct SunPoint {
    std::size_t column = 0;               //< its place in SunColumns::column
    std::array<std::size_t, 6> next{};    //< those along each axis, or kNoPoint
    formats::Vec3 world;                  //< [m]
    std::array<std::uint32_t, 8> node{};  //< or kNoNode
    std::array<float, 8> weight{};        //< of nodes; the sum is 1, or 0 where none is
};

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

// What V^power at a point is to be multiplied by so that lines between points, which are above an
// exponential between its ends, have its mean:
//
//     1 / (1 + max(0, s)),   s = sum over the points next to it of (e^(power (tau - tau_i)) - 1) /
//     12
//
// with tau the optical depth that the volume itself has before a point, and e^x = 1 + x + x^2 / 2,
// e^-x its inverse: of an even medium the mean is right to 4 % up to depths of 2.4 between points.
Rgb find_lowering(const SunPoint& point, std::span<const float> column, Rgb sigma_t, float power) {
    Rises way{};
    for (std::size_t i = 0; i < point.next.size(); ++i) {
        if (point.next[i] != kNoPoint) way[i] = column[point.column] - column[point.next[i]];
    }
    const float red = lowering(way, power * sigma_t.r);
    if (sigma_t.r == sigma_t.g && sigma_t.g == sigma_t.b) return {red, red, red};
    return {red, lowering(way, power * sigma_t.g), lowering(way, power * sigma_t.b)};
}

// Everything that the bricks of a volume share.
struct SunPoints {
    std::span<const SunColumns> volumes;  // all that hold density
    std::size_t own;                      // of those
    std::span<const Rgb> reach;
    std::vector<std::vector<std::size_t>> shades;  // of each sun: others of `volumes`
    VolumeLight& light;

    const SunColumns& columns() const { return volumes[own]; }
    const VolumeLight::Part& part() const { return light.part[columns().volume]; }
};

// U_s at a point; 1 where no node is.
Rgb reach_at(const SunPoints& points, const SunPoint& point, std::size_t sun) {
    Rgb sum;
    float whole = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        if (point.weight[i] == 0) continue;
        sum = sum + point.weight[i] * points.reach[point.node[i] * points.part().suns + sun];
        whole += point.weight[i];
    }
    return whole > 0 ? sum : Rgb{1, 1, 1};
}

// The share of a sun's light that all volumes leave.
Rgb find_share(const SunPoints& points, const SunPoint& point, std::size_t sun) {
    const auto depth_of = [](const SunColumns& volume, float column) {
        return tame(column * volume.lattice.record->sigma_t, kLargestExtinction);
    };
    const SunColumns& own = points.columns();
    Rgb depth = depth_of(own, own.column[sun][point.column]);
    for (const std::size_t other : points.shades[sun]) {
        const SunColumns& volume = points.volumes[other];
        depth =
            depth + depth_of(volume, column_from(volume, sun, points.light.sun[sun], point.world));
    }
    const float red = std::exp(-depth.r);
    // Exponentials are dear, and most smoke is grey.
    if (depth.r == depth.g && depth.g == depth.b) return {red, red, red};
    return {red, std::exp(-depth.g), std::exp(-depth.b)};
}

void light_point(const SunPoints& points, const SunPoint& point, std::span<Rgb> coefficient) {
    const formats::VolumeRecord& record = *points.columns().lattice.record;
    const VolumeLight::Part& part = points.part();
    // Coloured rows may also hold hues of the albedo, which densities lack.
    const float most = record.bands == 1 ? 2.0f : 1.0f;
    for (std::size_t s = 0; s < part.suns; ++s) {
        const Rgb known = find_share(points, point, s);
        const Rgb rows = most * reach_at(points, point, s);
        const Rgb share{std::min(known.r, rows.r), std::min(known.g, rows.g),
                        std::min(known.b, rows.b)};
        const SunThrough through =
            find_sun_through(points.light.sun_phase[points.columns().volume], record.albedo, share);
        const Rgb arrives = share * points.light.sun_light(points.columns().volume, s);
        for (std::size_t j = 0; j < part.sun_terms; ++j) {
            const Rgb lowered =
                find_lowering(point, points.columns().column[s], record.sigma_t,
                              1 + part.sun_power[j] * formats::luminance(record.albedo));
            coefficient[j * part.suns + s] =
                tame(lowered * through[j] * arrives, std::numeric_limits<float>::max());
        }
    }
}

// Points in another brick are copied from it, or computed.
void light_brick(const SunPoints& points, std::uint32_t brick, bool copies) {
    const VolumeLight::Part& part = points.part();
    const auto coefficient = [&](std::uint32_t of, std::size_t point) {
        return std::span(points.light.coefficient)
            .subspan(part.first_of_brick(of) + point * part.sun_stride(), part.sun_stride());
    };
    const SunColumns& columns = points.columns();
    const BrickSurroundings around = brick_surroundings(columns, brick);
    const std::uint32_t boxes = part.sun_boxes;
    std::size_t number = 0;
    for (std::uint32_t z = 0; z <= boxes; ++z) {
        for (std::uint32_t y = 0; y <= boxes; ++y) {
            for (std::uint32_t x = 0; x <= boxes; ++x, ++number) {
                const PointOwner owner = point_owner(brick, around.block, boxes, {x, y, z});
                if ((owner.brick != brick) != copies) continue;
                if (copies) {
                    std::ranges::copy(coefficient(owner.brick, owner.point),
                                      coefficient(brick, number).begin());
                } else {
                    light_point(points, make_sun_point(columns, around, {x, y, z}),
                                coefficient(brick, number));
                }
            }
        }
    }
}

}  // namespace

void light_sun_points(const formats::VolumesView& volumes, std::span<const std::vector<Rgb>> reach,
                      unsigned threads, VolumeLight& light) {
    if (std::ranges::none_of(light.part, [](const auto& part) { return part.suns > 0; })) return;
    std::vector<SunColumns> placed = place_volumes(volumes);
    find_sun_columns(placed, light.sun, threads);
    for (std::size_t own = 0; own < placed.size(); ++own) {
        if (light.part[placed[own].volume].suns == 0) continue;
        const SunPoints points{placed, own, reach[placed[own].volume],
                               find_shades(placed, own, light.sun), light};
        const auto count = static_cast<std::uint32_t>(placed[own].cell_of_brick.size());
        for (const bool copies : {false, true}) {
            constexpr std::uint32_t kBricks = 16;
            for_ranges(count, kBricks, threads, [&](std::uint32_t first, std::uint32_t end) {
                for (std::uint32_t brick = first; brick < end; ++brick) {
                    light_brick(points, brick, copies);
                }
            });
        }
    }
}

}  // namespace opaline::runtime
