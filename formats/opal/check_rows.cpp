#include "formats/opal/check_rows.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/cubemap.h"

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

}  // namespace opaline::formats
