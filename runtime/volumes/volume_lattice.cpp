#include "runtime/volumes/volume_lattice.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/half.h"

namespace opaline::runtime {
namespace {

using formats::kBrickSide;
using formats::kBrickVoxels;
using formats::kNoBrick;
using formats::VolumeRecord;

// Inverse of a 3 x 4 affine matrix by cofactors, columns scaled to length 1 first, so that voxels
// of any size neither overflow nor vanish.
std::optional<std::array<double, 12>> inverse_of(const std::array<float, 12>& matrix) {
    std::array<std::array<double, 3>, 3> column{};
    std::array<double, 3> size{}, origin{};
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t r = 0; r < 3; ++r) {
            column[c][r] = static_cast<double>(matrix[4 * r + c]);
        }
        size[c] = std::hypot(column[c][0], column[c][1], column[c][2]);
        origin[c] = static_cast<double>(matrix[4 * c + 3]);
        if (!(size[c] > 0) || !std::isfinite(size[c])) return std::nullopt;
        for (double& value : column[c]) {
            value /= size[c];
        }
    }
    const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                     a[0] * b[1] - a[1] * b[0]};
    };
    const auto dot = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    const double determinant = dot(column[0], cross(column[1], column[2]));
    constexpr double kFlat = 1e-9;
    if (!(std::abs(determinant) > kFlat)) return std::nullopt;
    std::array<double, 12> inverse{};
    for (std::size_t r = 0; r < 3; ++r) {
        const auto cofactor = cross(column[(r + 1) % 3], column[(r + 2) % 3]);
        for (std::size_t c = 0; c < 3; ++c) {
            inverse[4 * r + c] = cofactor[c] / determinant / size[r];
        }
        inverse[4 * r + 3] = -(inverse[4 * r] * origin[0] + inverse[4 * r + 1] * origin[1] +
                               inverse[4 * r + 2] * origin[2]);
    }
    if (!std::ranges::all_of(inverse, [](double x) { return std::isfinite(x); })) {
        return std::nullopt;
    }
    return inverse;
}

float voxel(const VolumeLattice& lattice, std::uint32_t brick, std::size_t offset) {
    return brick == kNoBrick
               ? 0.0f
               : lattice.density_scale[brick] *
                     static_cast<float>(lattice.density[brick * kBrickVoxels + offset]);
}

constexpr float mix(float a, float b, float weight) {
    return a + weight * (b - a);
}

float trilinear(const std::array<float, 8>& v, const std::array<float, 3>& w) {
    return mix(mix(mix(v[0], v[1], w[0]), mix(v[2], v[3], w[0]), w[1]),
               mix(mix(v[4], v[5], w[0]), mix(v[6], v[7], w[0]), w[1]), w[2]);
}

}  // namespace

std::uint32_t VolumeLattice::brick(std::array<std::int32_t, 3> cell) const {
    for (std::size_t a = 0; a < 3; ++a) {
        if (cell[a] < 0 || static_cast<std::uint32_t>(cell[a]) >= record->extent[a])
            return kNoBrick;
    }
    const auto at = [&](std::size_t a) { return static_cast<std::size_t>(cell[a]); };
    return table[(at(2) * record->extent[1] + at(1)) * record->extent[0] + at(0)];
}

std::optional<VolumeLattice> make_lattice(const formats::VolumesView& volumes,
                                          const VolumeRecord& record) {
    const auto inverse = inverse_of(record.to_world);
    if (!inverse) return std::nullopt;
    const std::size_t cells = std::size_t{record.extent[0]} * record.extent[1] * record.extent[2];
    VolumeLattice lattice;
    lattice.record = &record;
    lattice.to_index = *inverse;
    lattice.table = volumes.table.subspan(record.first_cell, cells);
    lattice.density_scale =
        volumes.density_scale.subspan(record.first_brick_number, record.brick_count);
    lattice.density = volumes.density.subspan(record.first_brick_number * kBrickVoxels,
                                              record.brick_count * kBrickVoxels);
    lattice.corner =
        volumes.corner.subspan(record.first_corner, record.brick_count * record.corners_of_brick());
    return lattice;
}

std::array<double, 3> index_of_direction(const VolumeLattice& lattice, formats::Vec3 d) {
    const auto& m = lattice.to_index;
    const auto x = static_cast<double>(d.x), y = static_cast<double>(d.y),
               z = static_cast<double>(d.z);
    return {m[0] * x + m[1] * y + m[2] * z, m[4] * x + m[5] * y + m[6] * z,
            m[8] * x + m[9] * y + m[10] * z};
}

std::array<double, 3> index_of_point(const VolumeLattice& lattice, formats::Vec3 p) {
    const std::array<double, 3> linear = index_of_direction(lattice, p);
    return {linear[0] + lattice.to_index[3], linear[1] + lattice.to_index[7],
            linear[2] + lattice.to_index[11]};
}

BrickBlock brick_block(const VolumeLattice& lattice, std::array<std::int32_t, 3> cell) {
    BrickBlock block{cell, {}};
    for (std::size_t i = 0; i < 8; ++i) {
        const auto bit = [i](std::size_t axis) { return static_cast<std::int32_t>(i >> axis & 1); };
        block.number[i] = lattice.brick({cell[0] + bit(0), cell[1] + bit(1), cell[2] + bit(2)});
    }
    return block;
}

float density_at(const VolumeLattice& lattice, const BrickBlock& block, std::array<float, 3> at) {
    std::array<std::size_t, 3> base{};
    std::array<float, 3> weight{};
    bool is_inside = true;
    for (std::size_t a = 0; a < 3; ++a) {
        base[a] = std::min<std::size_t>(static_cast<std::size_t>(at[a]), kBrickSide - 1);
        weight[a] = at[a] - static_cast<float>(base[a]);
        is_inside = is_inside && base[a] + 1 < kBrickSide;
    }
    std::array<float, 8> value{};
    if (is_inside) {
        const std::uint16_t* const code = lattice.density.data() + block.number[0] * kBrickVoxels +
                                          (base[2] * kBrickSide + base[1]) * kBrickSide + base[0];
        for (std::size_t i = 0; i < 8; ++i) {
            value[i] = static_cast<float>(
                code[((i >> 2) * kBrickSide + (i >> 1 & 1)) * kBrickSide + (i & 1)]);
        }
        return lattice.density_scale[block.number[0]] * trilinear(value, weight);
    }
    for (std::size_t i = 0; i < 8; ++i) {
        std::size_t neighbour = 0, offset = 0;
        for (std::size_t a = 3; a-- > 0;) {
            const std::size_t position = base[a] + (i >> a & 1);
            neighbour |= (position / kBrickSide) << a;
            offset = offset * kBrickSide + position % kBrickSide;
        }
        value[i] = voxel(lattice, block.number[neighbour], offset);
    }
    return trilinear(value, weight);
}

PaddedBrick pad_brick(const VolumeLattice& lattice, std::array<std::int32_t, 3> cell) {
    const BrickBlock block = brick_block(lattice, cell);
    PaddedBrick value{};
    for (std::size_t i = 0; i < value.size(); ++i) {
        const std::array<std::size_t, 3> at{i % kPaddedSide, i / kPaddedSide % kPaddedSide,
                                            i / kPaddedSide / kPaddedSide};
        std::size_t neighbour = 0, offset = 0;
        for (std::size_t a = 3; a-- > 0;) {
            neighbour |= (at[a] / kBrickSide) << a;
            offset = offset * kBrickSide + at[a] % kBrickSide;
        }
        value[i] = voxel(lattice, block.number[neighbour], offset);
    }
    return value;
}

NodeCell node_cell(const VolumeLattice& lattice, std::array<float, 3> at) {
    return box_at(kBrickSide / lattice.record->spacing, at);
}

std::uint32_t sun_boxes(const VolumeRecord& record) {
    return std::min<std::uint32_t>(2 * kBrickSide / record.spacing, kBrickSide);
}

NodeCell box_at(std::uint32_t boxes, std::array<float, 3> at) {
    NodeCell cell;
    for (std::size_t a = 3; a-- > 0;) {
        // A power of two: exact.
        const float scaled = at[a] * (static_cast<float>(boxes) / kBrickSide);
        const std::uint32_t base = std::min(static_cast<std::uint32_t>(scaled), boxes - 1);
        cell.weight[a] = scaled - static_cast<float>(base);
        cell.number = cell.number * boxes + base;
    }
    return cell;
}

std::array<std::uint32_t, 8> nodes_of_cell(const VolumeLattice& lattice, std::uint32_t brick,
                                           std::uint32_t cell) {
    const std::size_t side = lattice.record->corners_along_edge(), cells = side - 1;
    const std::size_t x = cell % cells, y = cell / cells % cells, z = cell / cells / cells;
    const std::uint32_t* const corner = lattice.corner.data() +
                                        brick * lattice.record->corners_of_brick() +
                                        (z * side + y) * side + x;
    std::array<std::uint32_t, 8> nodes{};
    for (std::size_t i = 0; i < 8; ++i) {
        nodes[i] = corner[((i >> 2) * side + (i >> 1 & 1)) * side + (i & 1)];
    }
    return nodes;
}

BrickWalk start_walk(const VolumeLattice& lattice, formats::Vec3 origin, formats::Vec3 direction,
                     double begin, double end) {
    BrickWalk walk;
    walk.origin = index_of_point(lattice, origin);
    walk.direction = index_of_direction(lattice, direction);
    bool moves = false, is_finite = !std::isnan(begin) && !std::isnan(end);
    for (std::size_t a = 0; a < 3; ++a) {
        walk.origin[a] = walk.origin[a] / kBrickSide - lattice.record->first_brick[a];
        walk.direction[a] /= kBrickSide;
        is_finite = is_finite && std::isfinite(walk.origin[a]) && std::isfinite(walk.direction[a]);
        moves = moves || walk.direction[a] != 0;
    }
    if (!is_finite || !moves) return walk;
    // Cut to the slabs between the table's faces.
    for (std::size_t a = 0; a < 3; ++a) {
        const double extent = lattice.record->extent[a];
        if (walk.direction[a] == 0) {
            if (walk.origin[a] < 0 || walk.origin[a] > extent) return walk;
            continue;
        }
        const double low = -walk.origin[a] / walk.direction[a];
        const double high = (extent - walk.origin[a]) / walk.direction[a];
        begin = std::max(begin, std::min(low, high));
        end = std::min(end, std::max(low, high));
    }
    if (!(begin < end) || !std::isfinite(begin) || !std::isfinite(end)) return walk;
    walk.t = begin;
    walk.end = end;
    for (std::size_t a = 0; a < 3; ++a) {
        const double at = walk.origin[a] + begin * walk.direction[a];
        const double last = static_cast<double>(lattice.record->extent[a]) - 1;
        if (!std::isfinite(at)) {
            walk.end = walk.t;
            return walk;
        }
        walk.cell[a] = static_cast<std::int32_t>(std::clamp(std::floor(at), 0.0, last));
    }
    return walk;
}

std::optional<BrickSpan> next_brick(const VolumeLattice& lattice, BrickWalk& walk) {
    while (walk.t < walk.end) {
        // The face through which the ray leaves this cell.
        double leaves = HUGE_VAL;
        std::size_t axis = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            if (walk.direction[a] == 0) continue;
            const double face = walk.cell[a] + (walk.direction[a] > 0 ? 1.0 : 0.0);
            const double t = (face - walk.origin[a]) / walk.direction[a];
            if (t < leaves) {
                leaves = t;
                axis = a;
            }
        }
        const BrickSpan span{walk.t, std::min(leaves, walk.end), walk.cell};
        walk.t = std::max(walk.t, span.end);
        walk.cell[axis] += walk.direction[axis] > 0 ? 1 : -1;
        if (walk.cell[axis] < 0 ||
            static_cast<std::uint32_t>(walk.cell[axis]) >= lattice.record->extent[axis]) {
            walk.end = walk.t;
        }
        if (span.begin < span.end && lattice.brick(span.cell) != formats::kNoBrick) return span;
    }
    return std::nullopt;
}

using formats::Rgb;

VolumeGlow make_glow(const formats::VolumesView& volumes, std::size_t volume) {
    VolumeGlow glow;
    const formats::GlowRecord* const record = volumes.glow.own_of(volume);
    if (record == nullptr) return glow;
    glow.place.assign(volumes.records[volume].brick_count, kNoBrick);
    for (std::uint32_t i = 0; i < record->brick_count; ++i) {
        glow.place[volumes.glow.brick[record->first_brick + i]] = i;
    }
    glow.code = volumes.glow.code.subspan(record->first_brick * kBrickVoxels,
                                          record->brick_count * kBrickVoxels);
    glow.scale = record->code_scale;
    return glow;
}

Rgb glow_at(const VolumeGlow& glow, const BrickBlock& block, std::array<float, 3> at) {
    const auto place_of = [&](std::uint32_t brick) {
        return brick == kNoBrick ? kNoBrick : glow.place[brick];
    };
    if (std::ranges::all_of(block.number, [&](auto n) { return place_of(n) == kNoBrick; })) {
        return {};
    }
    std::array<std::size_t, 3> base{};
    std::array<float, 3> upper{};
    for (std::size_t a = 0; a < 3; ++a) {
        base[a] = std::min<std::size_t>(static_cast<std::size_t>(at[a]), kBrickSide - 1);
        upper[a] = at[a] - static_cast<float>(base[a]);
    }
    Rgb sum;
    for (std::size_t i = 0; i < 8; ++i) {
        std::size_t neighbour = 0, offset = 0;
        float weight = glow.scale;
        for (std::size_t a = 3; a-- > 0;) {
            const std::size_t position = base[a] + (i >> a & 1);
            neighbour |= (position / kBrickSide) << a;
            offset = offset * kBrickSide + position % kBrickSide;
            weight *= (i >> a & 1) != 0 ? upper[a] : 1 - upper[a];
        }
        const std::uint32_t place = place_of(block.number[neighbour]);
        if (place == kNoBrick) continue;
        sum = sum + weight * formats::unpack_shared(glow.code[place * kBrickVoxels + offset]);
    }
    return sum;
}

}  // namespace opaline::runtime
