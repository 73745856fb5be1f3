#pragma once

#include <cstdint>
#include <string>

#include "formats/opal/fault.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::formats {

/// True where the range first .. first + count - 1 lies in an array of `size` values.
constexpr bool lies_inside(std::uint64_t first, std::uint64_t count, std::uint64_t size) {
    return first <= size && count <= size - first;
}

/// What decoding any row relies on: offsets that ascend to the number of details, coefficient
/// indices below 6 n n. `section` says in which section the rows stand. Precondition: at least one
/// row offset, a valid cubemap_size.
Fault find_rows_fault(const SparseRowsView& rows, const std::string& section);

/// What a sound baker never writes: scales that are negative or not finite, indices out of order or
/// of face averages. Precondition: find_rows_fault found nothing.
Fault find_row_value_fault(const SparseRowsView& rows, const std::string& section);

/// Codes from first_code on that `count` rows need. Precondition: these rows exist.
std::uint64_t codes_of_rows(const SparseRowsView& rows, std::uint32_t first_row,
                            std::uint64_t count, std::uint32_t bands);

}  // namespace opaline::formats
