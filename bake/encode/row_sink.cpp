#include "bake/encode/row_sink.h"

#include <utility>

namespace opaline::bake {

RowEncoder make_row_encoder(std::uint32_t cubemap_size, std::uint32_t coefficients,
                            std::uint32_t code_bits) {
    return {make_selector(cubemap_size, coefficients), code_bits};
}

formats::SparseRows empty_rows(const RowEncoder& encoder) {
    return formats::make_sparse_rows(encoder.selector.cubemap_size, encoder.code_bits);
}

void encode_receiver(const RowEncoder& encoder, const DenseRow& row, formats::SparseRows& rows) {
    const std::size_t term_size = row.values.size() / row.terms;
    for (std::uint32_t k = 0; k < row.terms; ++k) {
        formats::append_row(
            rows, select_coefficients(encoder.selector,
                                      row.values.subspan(k * term_size, term_size), row.bands));
    }
}

RowSink make_row_sink(RowEncoder encoder) {
    formats::SparseRows rows = empty_rows(encoder);
    return {std::move(encoder), std::move(rows)};
}

bool take_rows(RowSink& sink, formats::SparseRows part) {
    const bool is_empty = sink.rows.row_offset.size() == 1;
    if (is_empty) {
        sink.rows = std::move(part);
        return true;
    }
    return formats::append_rows(sink.rows, part);
}

}  // namespace opaline::bake
