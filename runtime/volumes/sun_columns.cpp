#include "runtime/volumes/sun_columns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/parallel.h"
#include "runtime/volumes/column_sweep.h"
#include "runtime/volumes/volume_lattice.h"
#include "runtime/volumes/volume_source.h"

namespace opaline::runtime {
namespace {

using formats::kBrickSide;
using formats::kNoBrick;
using formats::Vec3;

// A volume's bricks in the order in which the light of a sun meets them, tile after tile.
struct ColumnJob {
    std::size_t volume, sun;
    std::optional<ColumnFrame> frame;
    std::vector<TileBrick> bricks;
};

// Those of one tile.
struct ColumnTask {
    const ColumnJob* job;
    std::size_t first, count;
};

std::vector<ColumnTask> list_tasks(std::span<const ColumnJob> jobs) {
    std::vector<ColumnTask> tasks;
    for (const ColumnJob& job : jobs) {
        for (std::size_t first = 0, end = 0; first < job.bricks.size(); first = end) {
            while (end < job.bricks.size() && is_same_tile(job.bricks[first], job.bricks[end])) {
                ++end;
            }
            tasks.push_back({&job, first, end - first});
        }
    }
    return tasks;
}

void copy_upper_faces(const SunColumns& volume, std::uint32_t brick, std::span<float> column) {
    const std::uint32_t boxes = volume.boxes();
    const std::size_t points = volume.points();
    const BrickBlock block = brick_block(volume.lattice, volume.cell(brick));
    std::size_t at = brick * points;
    for (std::uint32_t z = 0; z <= boxes; ++z) {
        for (std::uint32_t y = 0; y <= boxes; ++y) {
            for (std::uint32_t x = 0; x <= boxes; ++x, ++at) {
                if (std::max({x, y, z}) < boxes) continue;
                const PointOwner owner = point_owner(brick, block, boxes, {x, y, z});
                column[at] = column[owner.brick * points + owner.point];
            }
        }
    }
}

using formats::kBrickSide;
using formats::Vec3;

// The corners of a volume's table.
std::array<Vec3, 8> corners_of(const formats::VolumeRecord& record) {
    std::array<Vec3, 8> corner;
    const auto& m = record.to_world;
    for (std::size_t i = 0; i < 8; ++i) {
        std::array<double, 3> index{};
        for (std::size_t a = 0; a < 3; ++a) {
            const double upper = (i >> a & 1) != 0 ? record.extent[a] : 0;
            index[a] = kBrickSide * (record.first_brick[a] + upper);
        }
        const auto world = [&](std::size_t row) {
            auto sum = static_cast<double>(m[row + 3]);
            for (std::size_t a = 0; a < 3; ++a) {
                sum += static_cast<double>(m[row + a]) * index[a];
            }
            return static_cast<float>(sum);
        };
        corner[i] = {world(0), world(4), world(8)};
    }
    return corner;
}

struct Stretch {
    double low = HUGE_VAL, high = -HUGE_VAL;

    void take(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

// Both in voxels. NaN is anywhere.
bool may_meet(const Stretch& a, const Stretch& b) {
    constexpr double kRounding = 1;
    return !(a.high + kRounding < b.low) && !(b.high + kRounding < a.low);
}

// Places as columns of a volume see them: across as two axes and the height toward the sun.
struct Outline {
    Stretch u, v, height;
    bool is_finite = true;

    void take(const ColumnFrame& frame, const std::array<double, 3>& voxel) {
        const double along = voxel[frame.along];
        is_finite = is_finite && std::isfinite(voxel[0] + voxel[1] + voxel[2]);
        u.take(voxel[frame.u] - frame.slope_u * along);
        v.take(voxel[frame.v] - frame.slope_v * along);
        height.take(frame.ascends ? along : -along);
    }
};

bool may_shade(const SunColumns& volume, Vec3 sun, const std::array<Vec3, 8>& place) {
    const auto frame = make_column_frame(volume.lattice, sun);
    if (!frame) return false;
    const formats::VolumeRecord& record = *volume.lattice.record;
    Outline own, other;
    for (std::size_t i = 0; i < 8; ++i) {
        std::array<double, 3> corner{}, from = index_of_point(volume.lattice, place[i]);
        for (std::size_t a = 0; a < 3; ++a) {
            corner[a] = (i >> a & 1) != 0 ? static_cast<double>(kBrickSide) * record.extent[a] : 0;
            from[a] -= static_cast<double>(kBrickSide) * record.first_brick[a];
        }
        own.take(*frame, corner);
        other.take(*frame, from);
    }
    constexpr double kRounding = 1;
    if (!other.is_finite) return true;
    return may_meet(own.u, other.u) && may_meet(own.v, other.v) &&
           other.height.low <= own.height.high + kRounding;
}

}  // namespace

std::array<std::int32_t, 3> SunColumns::cell(std::uint32_t brick) const {
    const auto& extent = lattice.record->extent;
    const std::uint32_t at = cell_of_brick[brick];
    return {static_cast<std::int32_t>(at % extent[0]),
            static_cast<std::int32_t>(at / extent[0] % extent[1]),
            static_cast<std::int32_t>(at / extent[0] / extent[1])};
}

std::vector<SunColumns> place_volumes(const formats::VolumesView& volumes) {
    std::vector<SunColumns> placed;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const formats::VolumeRecord& record = volumes.records[v];
        const auto lattice = make_lattice(volumes, record);
        if (!lattice || lattice->table.empty() || record.brick_count == 0) continue;
        SunColumns& own = placed.emplace_back(SunColumns{*lattice, v, {}, {}});
        own.cell_of_brick.resize(record.brick_count);
        for (std::uint32_t at = 0; at < lattice->table.size(); ++at) {
            if (lattice->table[at] != kNoBrick) own.cell_of_brick[lattice->table[at]] = at;
        }
    }
    return placed;
}

PointOwner point_owner(std::uint32_t brick, const BrickBlock& block, std::uint32_t boxes,
                       const std::array<std::uint32_t, 3>& place) {
    std::size_t neighbour = 0, here = 0, there = 0;
    for (std::size_t a = 3; a-- > 0;) {
        const bool is_upper = place[a] == boxes;
        neighbour |= (is_upper ? std::size_t{1} : 0) << a;
        here = here * (boxes + 1) + place[a];
        there = there * (boxes + 1) + (is_upper ? 0 : place[a]);
    }
    const std::uint32_t owner = block.number[neighbour];
    if (owner == brick || owner == kNoBrick) return {brick, here};
    return {owner, there};
}

void find_sun_columns(std::span<SunColumns> volumes, std::span<const Vec3> suns, unsigned threads) {
    std::vector<ColumnJob> jobs;
    for (std::size_t v = 0; v < volumes.size(); ++v) {
        volumes[v].column.assign(suns.size(), {});
        for (std::size_t s = 0; s < suns.size(); ++s) {
            volumes[v].column[s].resize(volumes[v].cell_of_brick.size() * volumes[v].points());
            jobs.push_back({v, s, make_column_frame(volumes[v].lattice, suns[s]), {}});
        }
    }
    const auto count = static_cast<std::uint32_t>(jobs.size());
    const auto for_each = [threads](std::uint32_t many, const auto& work) {
        for_ranges(many, 1, threads, [&](std::uint32_t first, std::uint32_t end) {
            for (std::uint32_t i = first; i < end; ++i) {
                work(i);
            }
        });
    };
    for_each(count, [&](std::uint32_t i) {
        if (jobs[i].frame) jobs[i].bricks = list_tiles(volumes[jobs[i].volume], *jobs[i].frame);
    });
    const std::vector<ColumnTask> tasks = list_tasks(jobs);
    for_each(static_cast<std::uint32_t>(tasks.size()), [&](std::uint32_t i) {
        const ColumnJob& job = *tasks[i].job;
        SunColumns& volume = volumes[job.volume];
        sweep_tile(volume, *job.frame,
                   std::span(job.bricks).subspan(tasks[i].first, tasks[i].count),
                   volume.column[job.sun]);
    });
    for_each(count, [&](std::uint32_t i) {
        SunColumns& volume = volumes[jobs[i].volume];
        for (std::uint32_t brick = 0; brick < volume.cell_of_brick.size(); ++brick) {
            copy_upper_faces(volume, brick, volume.column[jobs[i].sun]);
        }
    });
}

float column_from(const SunColumns& volume, std::size_t number, Vec3 sun, Vec3 from) {
    BrickWalk walk = start_walk(volume.lattice, from, sun, 0, HUGE_VAL);
    const auto span = next_brick(volume.lattice, walk);
    if (!span) return 0;
    std::array<float, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double place = walk.origin[a] + span->begin * walk.direction[a] - span->cell[a];
        at[a] = tame(static_cast<float>(kBrickSide * place), kBrickSide);
    }
    const NodeCell box = box_at(volume.boxes(), at);
    const auto points = points_of_box(volume.boxes(), box.number);
    const std::array<float, 8> weight = corner_weights(box.weight);
    const std::size_t first = volume.lattice.brick(span->cell) * volume.points();
    float sum = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        sum += weight[i] * volume.column[number][first + points[i]];
    }
    return sum;
}

std::vector<std::vector<std::size_t>> find_shades(std::span<const SunColumns> volumes,
                                                  std::size_t own, std::span<const Vec3> suns) {
    std::vector<std::vector<std::size_t>> shades(suns.size());
    const std::array<Vec3, 8> place = corners_of(*volumes[own].lattice.record);
    for (std::size_t s = 0; s < suns.size(); ++s) {
        for (std::size_t v = 0; v < volumes.size(); ++v) {
            if (v != own && may_shade(volumes[v], suns[s], place)) shades[s].push_back(v);
        }
    }
    return shades;
}

}  // namespace opaline::runtime
