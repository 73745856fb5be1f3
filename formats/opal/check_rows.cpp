#include "formats/opal/check_rows.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/cubemap.h"

namespace opaline::formats {
namespace {

template <class T>
bool all_below(std::span<const T> values, std::uint32_t limit) {
    return std::all_of(values.begin(), values.end(), [limit](T v) { return v < limit; });
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
    for (std::uint32_t r = 0; r < rows.rows(); ++r) {
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

}  // namespace opaline::formats
