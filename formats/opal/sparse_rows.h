#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace opaline::formats {

/// One wavelet-compressed transport vector before quantisation.
/// `index` ascending, face averages (index = face * n * n) left out: they stand in `average`.
/// Values: band-major, value[band * index.size() + i]; average[band * 6 + face].
struct SparseRow {
    std::uint32_t bands = 1;  ///< 1: grey transport, 3: RGB
    std::vector<std::uint32_t> index;
    std::vector<float> value;
    std::vector<float> average;
};

/// Sparse quantised transport vectors as they stand in the file and in memory: a view, no copies.
///
/// A *row* is one transport vector T_k(x); a *band row* one colour band of it. Bands of a row share
/// its indices. Row r keeps the details row_offset[r] .. row_offset[r+1]. A primitive's rows are
/// consecutive and have equal band counts, so that
///     code of detail i, band b   = codes[first_code + (i - row_offset[first_row]) * bands + b]
///     band row of row r, band b  = first_band_row + (r - first_row) * bands + b.
/// Value of a detail = detail_value(code) * detail_scale[band row] (detail_codes.h); of a face
/// average = average_code[6 * band row + face] * average_scale[band row]. Worst rounding error of
/// an average and of a 16-bit detail: half a scale; of an 8-bit detail |code| + 1/2 scales.
struct SparseRowsView {
    std::uint32_t cubemap_size = 0;
    std::uint32_t code_bits = 8;    ///< 8 or 16: width of detail codes, two's complement
    std::uint32_t index_bytes = 2;  ///< 2, or 4 where 6 n n exceeds 65536
    std::span<const std::uint32_t> row_offset;   ///< rows + 1
    std::span<const float> average_scale;        ///< band rows
    std::span<const float> detail_scale;         ///< band rows
    std::span<const std::int16_t> average_code;  ///< 6 * band rows
    std::span<const std::uint16_t> index16;      ///< details, if index_bytes == 2
    std::span<const std::uint32_t> index32;      ///< details, if index_bytes == 4
    std::span<const std::int8_t> code8;          ///< details * bands, if code_bits == 8
    std::span<const std::int16_t> code16;        ///< details * bands, if code_bits == 16

    std::uint32_t rows() const {
        return row_offset.empty() ? 0 : static_cast<std::uint32_t>(row_offset.size() - 1);
    }
};

/// Owning twin of `SparseRowsView`; rows are appended in order.
struct SparseRows {
    std::uint32_t cubemap_size = 0;
    std::uint32_t code_bits = 8;
    std::uint32_t index_bytes = 2;
    std::vector<std::uint32_t> row_offset{0};
    std::vector<float> average_scale, detail_scale;
    std::vector<std::int16_t> average_code;
    std::vector<std::uint16_t> index16;
    std::vector<std::uint32_t> index32;
    std::vector<std::int8_t> code8;
    std::vector<std::int16_t> code16;

    SparseRowsView view() const;
};

/// Empty rows over a cube map of n x n texels; code_bits is 8 or 16.
SparseRows make_sparse_rows(std::uint32_t cubemap_size, std::uint32_t code_bits);

/// Quantises and appends one row: signed symmetric codes, one scale per band for the details and
/// one for the six averages (16 bits), round to nearest (formats/README.md, `TRAN`). If an average
/// or a detail of a band is NaN or infinite, its scale becomes NaN: the row decodes to NaN and
/// find_faulty_row finds it. Fails (returns false, nothing appended) if details would exceed 2^32 -
/// 1.
bool append_row(SparseRows& rows, const SparseRow& row);

/// The first row appended with a NaN or infinite value, if any. Every row has `bands` bands.
std::optional<std::uint32_t> find_faulty_row(const SparseRows& rows, std::uint32_t bands);

/// Appends all rows of `tail`, which must have the same basis and code width.
bool append_rows(SparseRows& rows, const SparseRows& tail);

/// Rows in another order: row i of the result is row from[i]. Every row of `rows` has `bands`
/// bands; each stands in `from` at most once.
SparseRows pick_rows(SparseRows rows, std::uint32_t bands, std::span<const std::uint32_t> from);

/// Where a primitive's rows stand (see SparseRowsView).
struct RowRange {
    std::uint32_t first_row = 0, rows = 0, bands = 1;
    std::uint32_t first_band_row = 0;
    std::uint64_t first_code = 0;
};

/// Decodes one band of one row into `dense` (6 n n values, overwritten): the reference for every
/// fast dot product. `row` counts from the start of the range.
void decode_row(const SparseRowsView& rows, const RowRange& range, std::uint32_t row,
                std::uint32_t band, std::span<float> dense);

}  // namespace opaline::formats
