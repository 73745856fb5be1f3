#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/opal/layout.h"
#include "formats/opal/section_cursor.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::formats {

/// Sparse rows as they stand in `TRAN`, and behind the volumes in `VOLU`: a head and six arrays.

TransportHead rows_head(const SparseRowsView& rows);

/// Head and arrays in the order of the file. They point into `head` and into what `rows` points to.
std::array<std::span<const std::byte>, 7> row_arrays(const TransportHead& head,
                                                     const SparseRowsView& rows);

/// Reads both; sets all of `rows` but its cubemap_size. False where they do not fit into what is
/// left of the section, or the head has widths that do not exist. What the arrays say is not looked
/// at: check_rows.h.
bool take_rows(SectionCursor& cursor, SparseRowsView& rows);

}  // namespace opaline::formats
