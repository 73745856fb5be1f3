#include "runtime/volumes/sun_columns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/volumes/column_sweep.h"

namespace opaline::runtime {
namespace {

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
