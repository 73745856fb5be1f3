#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/encode/select_coefficients.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/knobs.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// How rows are kept: as the largest coefficients, quantised.
struct RowEncoder {
    Selector selector;
    std::uint32_t code_bits = 8;
};
RowEncoder make_row_encoder(std::uint32_t cubemap_size, std::uint32_t coefficients,
                            std::uint32_t code_bits);

/// Rows under construction of any number of receivers, empty.
formats::SparseRows empty_rows(const RowEncoder& encoder);
/// Appends the rows of one receiver. Any thread may encode into rows of its own.
void encode_receiver(const RowEncoder& encoder, const DenseRow& row, formats::SparseRows& rows);

/// Takes the rows of all receivers of a file, part by part, in the order of the file.
struct RowSink {
    RowEncoder encoder;
    formats::SparseRows rows;
};
RowSink make_row_sink(RowEncoder encoder);
/// False: the file would hold more than 2^32 - 1 coefficients; nothing was taken.
bool take_rows(RowSink& sink, formats::SparseRows part);

}  // namespace opaline::bake
