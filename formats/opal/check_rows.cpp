#include "formats/opal/check_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "formats/opal/check_opal.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/half.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/used_part.h"

namespace opaline::formats {
namespace {

// The checks below read the largest arrays of a file: sums without a branch, which compilers make
// into vector instructions.

template <class T>
bool all_below(std::span<const T> values, std::uint32_t limit) {
    T largest = 0;
    for (const T v : values) {
        largest = std::max(largest, v);
    }
    return values.empty() || largest < limit;
}

// How many indices stand for a face's average, which is no detail.
template <class T>
std::size_t count_averages(std::span<const T> index, std::uint32_t face_size) {
    const auto mask = static_cast<T>(face_size - 1);  // a power of two
    std::size_t count = 0;
    for (std::size_t begin = 0; begin < index.size(); begin += 32768) {
        T part = 0;
        for (const T i : index.subspan(begin, std::min<std::size_t>(index.size() - begin, 32768))) {
            part = static_cast<T>(part + ((i & mask) == 0 ? 1 : 0));
        }
        count += part;
    }
    return count;
}

// How many indices are not above the one before them.
template <class T>
std::size_t count_descents(std::span<const T> index) {
    std::size_t count = 0;
    for (std::size_t begin = 1; begin < index.size(); begin += 32768) {
        const std::size_t end = std::min<std::size_t>(index.size(), begin + 32768);
        T part = 0;
        for (std::size_t i = begin; i < end; ++i) {
            part = static_cast<T>(part + (index[i] <= index[i - 1] ? 1 : 0));
        }
        count += part;
    }
    return count;
}

// True if the indices of every row are ascending details: every descent is between two rows.
template <class T>
bool are_ascending_details(std::span<const T> index, std::span<const std::uint32_t> row_offset,
                           std::uint32_t face_size) {
    std::size_t between = 0;
    for (std::size_t r = 1; r + 1 < row_offset.size(); ++r) {
        const std::uint32_t i = row_offset[r];
        const bool begins = i > 0 && i < row_offset[r + 1];  // a row that is not empty
        if (begins && index[i] <= index[i - 1]) ++between;
    }
    return count_averages(index, face_size) == 0 && count_descents(index) == between;
}

bool is_scale(float x) {
    return x >= 0 && x <= std::numeric_limits<float>::max() / kLargestHalf;
}

std::string find_brick_fault(const GlowView& glow, const GlowRecord& record,
                             const VolumeRecord& volume) {
    const auto bricks = glow.brick.subspan(record.first_brick, record.brick_count);
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        if (bricks[i] >= volume.brick_count || (i > 0 && bricks[i] <= bricks[i - 1])) {
            return "it refers to a brick that its volume does not have, or bricks are out of order";
        }
    }
    return {};
}

std::string find_record_fault(const AssetView& asset, std::size_t i, UsedPart& bricks,
                              UsedPart& values) {
    const GlowView& glow = asset.volumes.glow;
    const GlowRecord& record = glow.record[i];
    if (record.volume >= asset.volumes.records.size() || record.emitter >= asset.emitters.size()) {
        return "its volume or emitter does not exist";
    }
    if (i > 0) {
        const GlowRecord& before = glow.record[i - 1];
        if (std::pair(record.volume, record.emitter) <= std::pair(before.volume, before.emitter)) {
            return "it is out of order, or stands twice";
        }
    }
    if (record.brick_count > 0 && glow.own_of(record.volume) != &record) {
        return "its volume has light of its own from two emitters";
    }
    if ((record.terms != 0 && !is_harmonic_count(record.terms)) || !is_scale(record.value_scale) ||
        !is_scale(record.code_scale)) {
        return "it has " + number_in_fault(record.terms) +
               " terms, or scales below zero or too large; expected 0, 1, 4, 9, 16 or 25 terms";
    }
    const VolumeRecord& volume = asset.volumes.records[record.volume];
    const std::uint64_t count = std::uint64_t{3} * volume.node_count * record.terms;
    if (!bricks.take(record.first_brick, record.brick_count, glow.brick.size()) ||
        !values.take(record.first_value, count, glow.value.size())) {
        return "its bricks or values lie outside their arrays, or overlap with those of another "
               "volume";
    }
    return find_brick_fault(glow, record, volume);
}

bool is_alpha(float x) {
    return x >= 0 && x <= 1;
}

bool is_clear_share(const HoleRecord& hole) {
    const ClearShare clear = clear_share_of(hole);
    return is_alpha(clear.share) &&
           (clear.eta == 0 || (clear.eta >= 1 && std::isfinite(clear.eta)));
}

std::string find_hole_fault(const AssetView& asset, std::size_t i) {
    const HoleRecord& hole = asset.holes.record[i];
    if (hole.primitive >= asset.primitives.size() ||
        !asset.primitives[hole.primitive].is_opaque()) {
        return "its primitive does not exist, or is translucent";
    }
    if (i > 0 && hole.primitive <= asset.holes.record[i - 1].primitive) {
        return "it is out of order, or stands twice";
    }
    if (hole.mode != HoleMode::mask && hole.mode != HoleMode::blend) {
        return "it is neither a mask nor a blend";
    }
    if (!is_alpha(hole.alpha) || !(hole.cutoff >= 0) || !std::isfinite(hole.cutoff) ||
        !is_clear_share(hole)) {
        return "its alpha is not in 0 ... 1, its cutoff is below zero or not finite, or what "
               "passes it as glass is not in 0 ... 1 or of an index below 1";
    }
    return find_image_fault(asset, hole.image, hole.wrap_u, hole.wrap_v);
}

}  // namespace

Fault find_rows_fault(const SparseRowsView& rows, const std::string& section) {
    const std::uint32_t coefficients = cubemap_texels(rows.cubemap_size);
    if (rows.index_bytes == 2 && coefficients > 65536) {
        return {section,
                "2-byte indices cannot address " + std::to_string(coefficients) + " coefficients"};
    }
    if (rows.row_offset.front() != 0 ||
        rows.row_offset.back() != rows.index16.size() + rows.index32.size() ||
        !std::is_sorted(rows.row_offset.begin(), rows.row_offset.end())) {
        return {section, "row offsets are not ascending from 0 to the number of details"};
    }
    if (!all_below(rows.index16, coefficients) || !all_below(rows.index32, coefficients)) {
        return {section, "a coefficient index is not below " + std::to_string(coefficients)};
    }
    return {};
}

Fault find_row_value_fault(const SparseRowsView& rows, const std::string& section) {
    const auto sound = [](float scale) { return scale >= 0 && std::isfinite(scale); };
    if (!std::all_of(rows.average_scale.begin(), rows.average_scale.end(), sound) ||
        !std::all_of(rows.detail_scale.begin(), rows.detail_scale.end(), sound)) {
        return {section, "a scale is below zero or not finite"};
    }
    const std::uint32_t face_size = rows.cubemap_size * rows.cubemap_size;
    const bool sorted = rows.index_bytes == 2
                            ? are_ascending_details(rows.index16, rows.row_offset, face_size)
                            : are_ascending_details(rows.index32, rows.row_offset, face_size);
    for (std::uint32_t r = 0; !sorted && r < rows.rows(); ++r) {  // to name the row
        std::int64_t previous = -1;
        for (std::uint32_t i = rows.row_offset[r]; i < rows.row_offset[r + 1]; ++i) {
            const std::uint32_t index = rows.index_bytes == 2 ? rows.index16[i] : rows.index32[i];
            if (index <= previous || index % face_size == 0) {
                return {section + ", row " + std::to_string(r),
                        "its indices are not ascending details"};
            }
            previous = index;
        }
    }
    return {};
}

std::uint64_t codes_of_rows(const SparseRowsView& rows, std::uint32_t first_row,
                            std::uint64_t count, std::uint32_t bands) {
    const std::uint64_t details = rows.row_offset[first_row + count] - rows.row_offset[first_row];
    return details * bands;
}

Fault find_glow_fault(const AssetView& asset) {
    UsedPart bricks, values;
    return find_fault_in(
        "section GLOW, record", asset.volumes.glow.record.size(),
        [&](std::size_t i) { return find_record_fault(asset, i, bricks, values); });
}

Fault find_glow_value_fault(const GlowView& glow) {
    const auto bad = std::ranges::find_if_not(glow.value, is_half_finite);
    if (bad == glow.value.end()) return {};
    return {"section GLOW, value " + number_in_fault(bad - glow.value.begin()), "it is not finite"};
}

Fault find_holes_fault(const AssetView& asset) {
    const std::size_t alphas = asset.holes.vertex_alpha.size();
    if (alphas != 0 && alphas != asset.position.size()) {
        return {"section HOLE", "it has alpha of " + number_in_fault(alphas) +
                                    " vertices; expected none, or " +
                                    number_in_fault(asset.position.size())};
    }
    return find_fault_in("section HOLE, record", asset.holes.record.size(),
                         [&](std::size_t i) { return find_hole_fault(asset, i); });
}

Fault find_hole_value_fault(const HolesView& holes) {
    const auto bad = std::ranges::find_if_not(holes.vertex_alpha, is_alpha);
    if (bad == holes.vertex_alpha.end()) return {};
    return {"section HOLE, vertex " + number_in_fault(bad - holes.vertex_alpha.begin()),
            "its alpha is not in 0 ... 1"};
}

}  // namespace opaline::formats
