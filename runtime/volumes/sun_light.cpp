#include "runtime/volumes/sun_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/parallel.h"
#include "runtime/volumes/brick_walk.h"
#include "runtime/volumes/volume_lattice.h"
#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::kBrickSide;
using formats::kNoBrick;
using formats::Rgb;
using formats::Vec3;

constexpr double kSlack = 1e-3;  // of a step, which rounding may add
constexpr float kDarkest = 12;   // optical depth at which a march ends: 6e-6 of a sun is left

// work(brick) for each of `count`, in pieces.
template <class Work>
void for_bricks(std::uint32_t count, unsigned threads, const Work& work) {
    constexpr std::uint32_t kBricks = 4;
    for_ranges(count, kBricks, threads, [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t brick = first; brick < end; ++brick) {
            work(brick);
        }
    });
}

// A volume's density, ready for many rays.
struct Field {
    VolumeLattice lattice;
    std::vector<std::uint32_t> cell_of_brick;
    std::vector<PaddedBrick> density;  // of each brick
};

std::array<std::int32_t, 3> cell_of(const Field& field, std::uint32_t brick) {
    const auto& extent = field.lattice.record->extent;
    const std::uint32_t at = field.cell_of_brick[brick];
    return {static_cast<std::int32_t>(at % extent[0]),
            static_cast<std::int32_t>(at / extent[0] % extent[1]),
            static_cast<std::int32_t>(at / extent[0] / extent[1])};
}

std::optional<Field> make_field(const formats::VolumesView& volumes,
                                const formats::VolumeRecord& record, unsigned threads) {
    const auto lattice = make_lattice(volumes, record);
    if (!lattice || lattice->table.empty() || record.brick_count == 0) return std::nullopt;
    Field field{*lattice, std::vector<std::uint32_t>(record.brick_count),
                std::vector<PaddedBrick>(record.brick_count)};
    for (std::uint32_t at = 0; at < lattice->table.size(); ++at) {
        if (lattice->table[at] != kNoBrick) field.cell_of_brick[lattice->table[at]] = at;
    }
    for_bricks(record.brick_count, threads, [&](std::uint32_t brick) {
        field.density[brick] = pad_brick(*lattice, cell_of(field, brick));
    });
    return field;
}

// `at`: voxels from the brick's voxel (0, 0, 0).
float density_at(const PaddedBrick& brick, const std::array<float, 3>& at) {
    std::array<std::size_t, 3> base{};
    std::array<float, 3> w{};
    for (std::size_t a = 0; a < 3; ++a) {
        const float inside = tame(at[a], kBrickSide);
        base[a] = std::min<std::size_t>(static_cast<std::size_t>(inside), kBrickSide - 1);
        w[a] = inside - static_cast<float>(base[a]);
    }
    const float* const v = brick.data() + (base[2] * kPaddedSide + base[1]) * kPaddedSide + base[0];
    const auto along_x = [&](std::size_t i) { return v[i] + w[0] * (v[i + 1] - v[i]); };
    constexpr std::size_t kZ = kPaddedSide * kPaddedSide;
    const float low = along_x(0) + w[1] * (along_x(kPaddedSide) - along_x(0));
    const float high = along_x(kZ) + w[1] * (along_x(kZ + kPaddedSide) - along_x(kZ));
    return low + w[2] * (high - low);
}

// The sum of densities at the middles of `count` steps through a brick.
float sum_steps(const PaddedBrick& brick, const BrickWalk& walk, const BrickSpan& span, int count) {
    const double h = (span.end - span.begin) / count;
    std::array<float, 3> at{}, step{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double p = walk.origin[a] + (span.begin + 0.5 * h) * walk.direction[a];
        at[a] = static_cast<float>((p - span.cell[a]) * kBrickSide);
        step[a] = static_cast<float>(h * walk.direction[a] * kBrickSide);
    }
    float sum = 0;
    for (int i = 0; i < count; ++i) {
        const auto t = static_cast<float>(i);
        sum += density_at(brick, {at[0] + t * step[0], at[1] + t * step[1], at[2] + t * step[2]});
    }
    return sum;
}

// Density times way [m] from a point out of the volume, or to where it exceeds `most`.
float find_column(const Field& field, Vec3 from, Vec3 direction, float most) {
    const VolumeLattice& lattice = field.lattice;
    BrickWalk walk = start_walk(lattice, from, direction, 0, HUGE_VAL);
    if (!(walk.t < walk.end)) return 0;
    const auto& d = walk.direction;
    const double boxes = sun_boxes(*lattice.record);
    const double steps_a_metre = boxes * std::hypot(d[0], d[1], d[2]);
    float column = 0;
    for (std::optional<BrickSpan> span; column <= most && (span = next_brick(lattice, walk));) {
        const double length = span->end - span->begin;
        // A brick's diagonal is sqrt(3) of its edge.
        const double count = std::clamp(std::ceil(length * steps_a_metre - kSlack), 1.0, 2 * boxes);
        const PaddedBrick& brick = field.density[lattice.brick(span->cell)];
        column += static_cast<float>(length / count) *
                  sum_steps(brick, walk, *span, static_cast<int>(count));
    }
    return column;
}

// The share of a sun's light that all volumes leave.
Rgb find_share(std::span<const Field> fields, Vec3 from, Vec3 sun) {
    Rgb depth;
    for (const Field& field : fields) {
        const Rgb& sigma_t = field.lattice.record->sigma_t;
        const float least = std::min({sigma_t.r, sigma_t.g, sigma_t.b});
        const float most = least > 0 ? kDarkest / least : HUGE_VALF;
        const Rgb own = find_column(field, from, sun, most) * sigma_t;
        depth = depth + tame(own, kLargestExtinction);
    }
    return {std::exp(-depth.r), std::exp(-depth.g), std::exp(-depth.b)};
}

// Everything that the bricks of a volume share.
struct SunPoints {
    std::span<const Field> fields;
    const Field& own;
    std::size_t volume;
    std::span<const Rgb> reach;
    VolumeLight& light;
};

// The brick in which a brick's point stands: on its upper faces that is a neighbour, if there is
// one.
std::uint32_t owner_of(const SunPoints& points, std::array<std::int32_t, 3> cell,
                       const std::array<std::uint32_t, 3>& at, std::uint32_t boxes) {
    for (std::size_t a = 0; a < 3; ++a) {
        cell[a] += at[a] == boxes ? 1 : 0;
    }
    return points.own.lattice.brick(cell);
}

std::array<std::uint32_t, 3> place_of(std::size_t point, std::uint32_t side) {
    return {static_cast<std::uint32_t>(point % side),
            static_cast<std::uint32_t>(point / side % side),
            static_cast<std::uint32_t>(point / side / side)};
}

// U_s at a point of a brick; 1 where no node is.
Rgb reach_at(const SunPoints& points, std::uint32_t brick, const std::array<float, 3>& at,
             std::size_t sun, std::size_t suns) {
    const NodeCell cell = node_cell(points.own.lattice, at);
    const auto nodes = nodes_of_cell(points.own.lattice, brick, cell.number);
    const std::array<float, 8> weight = corner_weights(cell.weight);
    Rgb sum;
    float whole = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        if (nodes[i] == formats::kNoNode) continue;
        sum = sum + weight[i] * points.reach[nodes[i] * suns + sun];
        whole += weight[i];
    }
    return whole > 0 ? (1 / whole) * sum : Rgb{1, 1, 1};
}

void light_point(const SunPoints& points, std::uint32_t brick,
                 const std::array<std::uint32_t, 3>& place, std::span<Rgb> coefficient) {
    const formats::VolumeRecord& record = *points.own.lattice.record;
    const VolumeLight::Part& part = points.light.part[points.volume];
    const std::array<std::int32_t, 3> cell = cell_of(points.own, brick);
    const auto& m = record.to_world;
    std::array<float, 3> at{}, index{};
    for (std::size_t a = 0; a < 3; ++a) {
        at[a] = static_cast<float>(place[a]) * (kBrickSide / static_cast<float>(part.sun_boxes));
        index[a] = static_cast<float>(kBrickSide * (record.first_brick[a] + cell[a])) + at[a];
    }
    const auto world = [&](std::size_t row) {
        return m[row] * index[0] + m[row + 1] * index[1] + m[row + 2] * index[2] + m[row + 3];
    };
    const Vec3 from{world(0), world(4), world(8)};
    for (std::size_t s = 0; s < part.suns; ++s) {
        const Rgb known = find_share(points.fields, from, points.light.sun[s]);
        // Coloured rows may hold hues of the albedo, too, which densities do not know.
        const float most = record.bands == 1 ? 2.0f : 1.0f;
        const Rgb rows = most * reach_at(points, brick, at, s, part.suns);
        const Rgb share{std::min(known.r, rows.r), std::min(known.g, rows.g),
                        std::min(known.b, rows.b)};
        const SunThrough through =
            find_sun_through(points.light.sun_phase[points.volume], record.albedo, share);
        const Rgb arrives = share * points.light.sun_light(points.volume, s);
        for (std::size_t j = 0; j < part.sun_terms; ++j) {
            coefficient[j * part.suns + s] =
                tame(through[j] * arrives, std::numeric_limits<float>::max());
        }
    }
}

// Those of points that stand in another brick are copied behind it, or found.
void light_brick(const SunPoints& points, std::uint32_t brick, bool copies) {
    const VolumeLight::Part& part = points.light.part[points.volume];
    const std::uint32_t side = part.sun_boxes + 1;
    const std::array<std::int32_t, 3> cell = cell_of(points.own, brick);
    const auto coefficient = [&](std::uint32_t of, std::size_t point) {
        return std::span(points.light.coefficient)
            .subspan(part.first_of_brick(of) + point * part.sun_stride(), part.sun_stride());
    };
    for (std::size_t point = 0; point < std::size_t{side} * side * side; ++point) {
        std::array<std::uint32_t, 3> place = place_of(point, side);
        const std::uint32_t owner = owner_of(points, cell, place, part.sun_boxes);
        const bool is_own = owner == brick || owner == kNoBrick;
        if (is_own == copies) continue;
        if (is_own) {
            light_point(points, brick, place, coefficient(brick, point));
            continue;
        }
        for (std::uint32_t& along : place) {
            along %= part.sun_boxes;
        }
        const std::size_t there = (std::size_t{place[2]} * side + place[1]) * side + place[0];
        std::ranges::copy(coefficient(owner, there), coefficient(brick, point).begin());
    }
}

}  // namespace

void light_sun_points(const formats::VolumesView& volumes, std::span<const std::vector<Rgb>> reach,
                      unsigned threads, VolumeLight& light) {
    if (std::ranges::none_of(light.part, [](const auto& part) { return part.suns > 0; })) return;
    std::vector<Field> fields;
    std::vector<std::size_t> volume;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        if (auto field = make_field(volumes, volumes.records[v], threads)) {
            fields.push_back(std::move(*field));
            volume.push_back(v);
        }
    }
    for (std::size_t f = 0; f < fields.size(); ++f) {
        if (light.part[volume[f]].suns == 0) continue;
        const SunPoints points{fields, fields[f], volume[f], reach[volume[f]], light};
        for (const bool copies : {false, true}) {
            for_bricks(fields[f].lattice.record->brick_count, threads,
                       [&](std::uint32_t brick) { light_brick(points, brick, copies); });
        }
    }
}

}  // namespace opaline::runtime
