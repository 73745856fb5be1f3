#include "runtime/volumes/volume_bounds.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace opaline::runtime {
namespace {

// Of voxels with density or light of their own: the lowest and the highest along each axis.
struct VoxelBox {
    std::array<std::int64_t, 3> low{INT64_MAX, INT64_MAX, INT64_MAX};
    std::array<std::int64_t, 3> high{INT64_MIN, INT64_MIN, INT64_MIN};
};

// By brick of a volume, the codes of its own light; empty where it has none.
std::vector<std::span<const std::uint32_t>> glow_of(const formats::VolumesView& volumes,
                                                    std::size_t volume) {
    std::vector<std::span<const std::uint32_t>> glow(volumes.records[volume].brick_count);
    const formats::GlowRecord* const record = volumes.glow.own_of(volume);
    for (std::size_t i = 0; record != nullptr && i < record->brick_count; ++i) {
        const std::size_t at = record->first_brick + i;
        glow[volumes.glow.brick[at]] =
            volumes.glow.code.subspan(at * formats::kBrickVoxels, formats::kBrickVoxels);
    }
    return glow;
}

VoxelBox box_of(const formats::VolumesView& volumes, std::size_t volume) {
    const formats::VolumeRecord& record = volumes.records[volume];
    const auto glow = glow_of(volumes, volume);
    VoxelBox box;
    std::size_t cell = record.first_cell;
    for (std::uint32_t z = 0; z < record.extent[2]; ++z) {
        for (std::uint32_t y = 0; y < record.extent[1]; ++y) {
            for (std::uint32_t x = 0; x < record.extent[0]; ++x) {
                const std::uint32_t number = volumes.table[cell++];
                if (number == formats::kNoBrick) continue;
                const auto codes = volumes.density.subspan(
                    (std::size_t{record.first_brick_number} + number) * formats::kBrickVoxels,
                    formats::kBrickVoxels);
                const std::array<std::uint32_t, 3> brick{x, y, z};
                for (std::size_t i = 0; i < codes.size(); ++i) {
                    if (codes[i] == 0 && (glow[number].empty() || glow[number][i] == 0)) continue;
                    const std::array<std::size_t, 3> within{i % 8, i / 8 % 8, i / 64};
                    for (std::size_t a = 0; a < 3; ++a) {
                        const std::int64_t voxel =
                            (std::int64_t{record.first_brick[a]} + brick[a]) * formats::kBrickSide +
                            static_cast<std::int64_t>(within[a]);
                        box.low[a] = std::min(box.low[a], voxel);
                        box.high[a] = std::max(box.high[a], voxel);
                    }
                }
            }
        }
    }
    return box;
}

}  // namespace

std::vector<formats::Vec3> volume_corners(const formats::VolumesView& volumes, std::size_t volume) {
    std::vector<formats::Vec3> corners;
    const VoxelBox box = box_of(volumes, volume);
    for (std::size_t i = 0; i < 8 && box.low[0] <= box.high[0]; ++i) {
        std::array<float, 3> index{};
        for (std::size_t a = 0; a < 3; ++a) {
            index[a] = static_cast<float>((i >> a & 1) != 0 ? box.high[a] + 1 : box.low[a] - 1);
        }
        const auto row = [&](std::size_t r) {
            const auto& m = volumes.records[volume].to_world;
            return m[4 * r] * index[0] + m[4 * r + 1] * index[1] + m[4 * r + 2] * index[2] +
                   m[4 * r + 3];
        };
        corners.push_back({row(0), row(1), row(2)});
    }
    return corners;
}

std::vector<formats::Vec3> volume_corners(const formats::VolumesView& volumes) {
    std::vector<formats::Vec3> corners;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const std::vector<formats::Vec3> own = volume_corners(volumes, v);
        corners.insert(corners.end(), own.begin(), own.end());
    }
    return corners;
}

}  // namespace opaline::runtime
