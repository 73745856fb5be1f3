#include "runtime/volumes/sun_light.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "runtime/parallel.h"
#include "runtime/volumes/sun_columns.h"
#include "runtime/volumes/sun_point.h"
#include "runtime/volumes/volume_lattice.h"
#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

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
