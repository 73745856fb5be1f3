#include "formats/opal/check_volumes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "formats/opal/check_rows.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/used_part.h"

namespace opaline::formats {
namespace {

constexpr const char *kVolumesSection = "section VOLU", *kVolume = "section VOLU, volume";

// Parts of the arrays that volumes have used so far.
struct UsedParts {
    UsedPart cells, bricks, corners, nodes, rows, band_rows, codes;
};

std::span<const std::uint32_t> table_of(const VolumesView& volumes, const VolumeRecord& v) {
    const std::size_t cells = std::size_t{v.extent[0]} * v.extent[1] * v.extent[2];
    return volumes.table.subspan(v.first_cell, cells);
}

std::span<const std::uint32_t> corners_of(const VolumesView& volumes, const VolumeRecord& v) {
    return volumes.corner.subspan(v.first_corner, v.brick_count * v.corners_of_brick());
}

bool is_possible_count(std::uint32_t terms) {
    return terms == 0 || is_harmonic_count(terms);
}

// Index coordinates are found with the inverse. Each column taken with length 1, the determinant
// must not be 0 but for rounding, whatever the size of a voxel.
bool is_invertible(const std::array<float, 12>& to_world) {
    constexpr double kMinDeterminant = 1e-9;
    if (!std::all_of(to_world.begin(), to_world.end(), [](float x) { return std::isfinite(x); })) {
        return false;
    }
    std::array<double, 12> m;
    std::copy(to_world.begin(), to_world.end(), m.begin());
    double volume = 1;
    for (std::size_t column = 0; column < 3; ++column) {
        volume *= std::hypot(m[column], m[4 + column], m[8 + column]);
    }
    const auto minor_of = [&m](std::size_t a, std::size_t b) {
        return m[4 + a] * m[8 + b] - m[4 + b] * m[8 + a];
    };
    const double determinant =
        m[0] * minor_of(1, 2) - m[1] * minor_of(0, 2) + m[2] * minor_of(0, 1);
    return std::abs(determinant) > kMinDeterminant * volume;
}

std::string find_kind_fault(const VolumeRecord& v) {
    if (v.spacing != 1 && v.spacing != 2 && v.spacing != 4 && v.spacing != 8) {
        return "nodes every " + number_in_fault(v.spacing) + " voxels; expected 1, 2, 4 or 8";
    }
    if (!is_possible_count(v.single_terms) || !is_possible_count(v.multiple_terms) ||
        (v.bands != 1 && v.bands != 3)) {
        return number_in_fault(v.single_terms) + " terms of single scattering, " +
               number_in_fault(v.multiple_terms) + " of multiple scattering and " +
               number_in_fault(v.bands) +
               " bands; expected 0, 1, 4, 9, 16 or 25 terms and 1 or 3 bands";
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t first = v.first_brick[axis];
        if (first < -kMaxBrick || first + std::int64_t{v.extent[axis]} > kMaxBrick) {
            return "its bricks lie further than " + number_in_fault(kMaxBrick) + " from the origin";
        }
    }
    return is_invertible(v.to_world) ? "" : "its matrix is not finite or cannot be inverted";
}

std::string find_range_fault(const VolumesView& volumes, const VolumeRecord& v, UsedParts& used) {
    // Two extents cannot overflow 64 bits, three can.
    const std::uint64_t plane = std::uint64_t{v.extent[0]} * v.extent[1];
    if (v.extent[2] != 0 && plane > volumes.table.size() / v.extent[2]) {
        return "its table is larger than all tables";
    }
    if (!used.cells.take(v.first_cell, plane * v.extent[2], volumes.table.size()) ||
        !used.bricks.take(v.first_brick_number, v.brick_count, volumes.density_scale.size()) ||
        !used.corners.take(v.first_corner, v.brick_count * v.corners_of_brick(),
                           volumes.corner.size()) ||
        !used.nodes.take(v.first_node, v.node_count, volumes.node.size())) {
        return "its table, bricks, corners or nodes lie outside their arrays, or overlap with "
               "those of another volume";
    }
    const SparseRowsView& rows = volumes.rows;
    const std::uint64_t count = std::uint64_t{v.node_count} * v.terms();
    if (!used.rows.take(v.first_row, count, rows.rows()) ||
        !used.band_rows.take(v.first_band_row, count * v.bands, rows.detail_scale.size()) ||
        !used.codes.take(v.first_code, codes_of_rows(rows, v.first_row, count, v.bands),
                         rows.code8.size() + rows.code16.size())) {
        return "its rows or codes lie outside their arrays, or overlap with those of another "
               "volume";
    }
    return {};
}

std::string find_number_fault(const VolumesView& volumes, const VolumeRecord& v) {
    const auto beyond = [](std::uint32_t none, std::uint32_t count) {
        return [=](std::uint32_t n) { return n != none && n >= count; };
    };
    const auto table = table_of(volumes, v);
    if (std::any_of(table.begin(), table.end(), beyond(kNoBrick, v.brick_count))) {
        return "its table refers to a brick that it does not have";
    }
    const auto corners = corners_of(volumes, v);
    if (std::any_of(corners.begin(), corners.end(), beyond(kNoNode, v.node_count))) {
        return "a corner of a brick refers to a node that it does not have";
    }
    return {};
}

std::string find_record_value_fault(const VolumeRecord& v) {
    const auto sound = [](float x, float largest) { return x >= 0 && x <= largest; };
    constexpr float kLargest = std::numeric_limits<float>::max();
    if (!sound(v.sigma_t.r, kLargest) || !sound(v.sigma_t.g, kLargest) ||
        !sound(v.sigma_t.b, kLargest)) {
        return "its extinction is below zero or not finite";
    }
    if (!sound(v.albedo.r, 1) || !sound(v.albedo.g, 1) || !sound(v.albedo.b, 1)) {
        return "its albedo is not in 0 ... 1";
    }
    constexpr float kRounding = 1e-4f;  // of moments that are sums over a table
    if (!std::all_of(v.moment.begin(), v.moment.end(),
                     [](float m) { return std::abs(m) <= 1 + kRounding; })) {
        return "a moment of its phase function is not in -1 ... 1";
    }
    if (v.single_terms > 0 && v.moment[0] < 1 - kRounding) {
        return "its phase function has moment 0 of " + number_in_fault(v.moment[0]) +
               "; expected 1";
    }
    return {};
}

std::string find_phase_fault(const VolumesView& volumes, const VolumeRecord& v) {
    const auto phase = volumes.phase_of(static_cast<std::size_t>(&v - volumes.records.data()));
    if (!std::all_of(phase.begin(), phase.end(),
                     [](float p) { return p >= 0 && std::isfinite(p); })) {
        return "its phase function is below zero or not finite";
    }
    constexpr double kTolerance = 1e-3;  // far above the rounding of floats
    const double integral = integrate_phase_table(phase);
    if (v.single_terms > 0 && !(std::abs(integral - 1) <= kTolerance)) {
        return "its phase function integrates to " + number_in_fault(integral) + "; expected 1";
    }
    return {};
}

// Of one brick, whose cell of the table counts from its lowest corner.
bool has_nodes_in_place(const VolumesView& volumes, const VolumeRecord& v, std::uint32_t brick,
                        const std::array<std::uint32_t, 3>& cell) {
    const std::uint32_t side = v.corners_along_edge();
    NodeVoxel lowest;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lowest[axis] = kBrickSide * (v.first_brick[axis] + static_cast<std::int32_t>(cell[axis]));
    }
    const auto spacing = static_cast<std::int32_t>(v.spacing);
    const auto corners =
        corners_of(volumes, v).subspan(brick * v.corners_of_brick(), v.corners_of_brick());
    for (std::uint32_t c = 0; c < corners.size(); ++c) {
        if (corners[c] == kNoNode) continue;
        const auto x = static_cast<std::int32_t>(c % side);
        const auto y = static_cast<std::int32_t>(c / side % side);
        const auto z = static_cast<std::int32_t>(c / side / side);
        if (volumes.node[v.first_node + corners[c]] !=
            NodeVoxel{lowest[0] + spacing * x, lowest[1] + spacing * y, lowest[2] + spacing * z}) {
            return false;
        }
    }
    return true;
}

std::string find_brick_value_fault(const VolumesView& volumes, const VolumeRecord& v) {
    const auto scales = volumes.density_scale.subspan(v.first_brick_number, v.brick_count);
    const auto sound = [](float scale) { return scale >= 0 && std::isfinite(65535.0f * scale); };
    if (!std::all_of(scales.begin(), scales.end(), sound)) {
        return "the density of a brick is below zero or not finite";
    }
    const auto table = table_of(volumes, v);
    std::size_t at = 0;
    for (std::uint32_t z = 0; z < v.extent[2]; ++z) {
        for (std::uint32_t y = 0; y < v.extent[1]; ++y) {
            for (std::uint32_t x = 0; x < v.extent[0]; ++x, ++at) {
                if (table[at] != kNoBrick &&
                    !has_nodes_in_place(volumes, v, table[at], {x, y, z})) {
                    return "a corner of a brick refers to a node that stands elsewhere";
                }
            }
        }
    }
    return {};
}

}  // namespace

Fault find_volumes_fault(const VolumesView& volumes) {
    if (volumes.rows.row_offset.empty()) {
        return volumes.empty() ? Fault{} : Fault{kVolumesSection, "it has no rows"};
    }
    UsedParts used;
    return find_first_fault(
        [&] { return find_rows_fault(volumes.rows, kVolumesSection); },
        [&] {
            return find_fault_in(kVolume, volumes.records.size(), [&](std::size_t i) {
                const VolumeRecord& v = volumes.records[i];
                return find_first_fault([&] { return find_kind_fault(v); },
                                        [&] { return find_range_fault(volumes, v, used); },
                                        [&] { return find_number_fault(volumes, v); });
            });
        });
}

Fault find_volume_value_fault(const VolumesView& volumes) {
    if (volumes.empty()) return {};
    return find_first_fault(
        [&] { return find_row_value_fault(volumes.rows, kVolumesSection); },
        [&] {
            return find_fault_in(kVolume, volumes.records.size(), [&](std::size_t i) {
                const VolumeRecord& v = volumes.records[i];
                return find_first_fault([&] { return find_record_value_fault(v); },
                                        [&] { return find_phase_fault(volumes, v); },
                                        [&] { return find_brick_value_fault(volumes, v); });
            });
        });
}

}  // namespace opaline::formats
