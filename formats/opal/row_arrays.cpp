#include "formats/opal/row_arrays.h"

namespace opaline::formats {

TransportHead rows_head(const SparseRowsView& rows) {
    return {rows.rows(),
            rows.code_bits,
            rows.index_bytes,
            0,
            rows.detail_scale.size(),
            rows.index16.size() + rows.index32.size(),
            rows.code8.size() + rows.code16.size(),
            0};
}

std::array<std::span<const std::byte>, 7> row_arrays(const TransportHead& head,
                                                     const SparseRowsView& rows) {
    return {std::as_bytes(std::span(&head, 1)),
            std::as_bytes(rows.row_offset),
            std::as_bytes(rows.average_scale),
            std::as_bytes(rows.detail_scale),
            std::as_bytes(rows.average_code),
            rows.index_bytes == 2 ? std::as_bytes(rows.index16) : std::as_bytes(rows.index32),
            rows.code_bits == 8 ? std::as_bytes(rows.code8) : std::as_bytes(rows.code16)};
}

bool take_rows(SectionCursor& cursor, SparseRowsView& rows) {
    TransportHead head;
    if (!cursor.take_one(head) || (head.code_bits != 8 && head.code_bits != 16) ||
        (head.index_bytes != 2 && head.index_bytes != 4) || head.band_rows > UINT64_MAX / 6) {
        return false;
    }
    rows.code_bits = head.code_bits;
    rows.index_bytes = head.index_bytes;
    return cursor.take(std::uint64_t{head.rows} + 1, rows.row_offset) &&
           cursor.take(head.band_rows, rows.average_scale) &&
           cursor.take(head.band_rows, rows.detail_scale) &&
           cursor.take(head.band_rows * 6, rows.average_code) &&
           (head.index_bytes == 2 ? cursor.take(head.details, rows.index16)
                                  : cursor.take(head.details, rows.index32)) &&
           (head.code_bits == 8 ? cursor.take(head.codes, rows.code8)
                                : cursor.take(head.codes, rows.code16));
}

}  // namespace opaline::formats
