#pragma once

#include <span>
#include <type_traits>

#include "runtime/dot.h"

namespace opaline::runtime {

/// The arrays that one range of rows consists of, with the widths as types. Internal to dot.
template <class Index, class Code>
struct TypedRows {
    const std::uint32_t* row_offset = nullptr;  ///< of the range's first row, and on
    const Index* index = nullptr;               ///< of the whole asset
    const Code* code = nullptr;                 ///< of the range's first detail, and on
    const float* average_scale = nullptr;       ///< of the range's first band row, and on
    const float* detail_scale = nullptr;
    const std::int16_t* average_code = nullptr;
};

template <class Index, class Code>
TypedRows<Index, Code> typed_rows(const formats::SparseRowsView& rows,
                                  const formats::RowRange& range) {
    TypedRows<Index, Code> typed;
    typed.row_offset = rows.row_offset.data() + range.first_row;
    if constexpr (std::is_same_v<Index, std::uint16_t>) {
        typed.index = rows.index16.data();
    } else {
        typed.index = rows.index32.data();
    }
    if constexpr (std::is_same_v<Code, std::int8_t>) {
        typed.code = rows.code8.data() + range.first_code;
    } else {
        typed.code = rows.code16.data() + range.first_code;
    }
    typed.average_scale = rows.average_scale.data() + range.first_band_row;
    typed.detail_scale = rows.detail_scale.data() + range.first_band_row;
    typed.average_code = rows.average_code.data() + std::size_t{range.first_band_row} * 6;
    return typed;
}

/// Calls f.operator()<Index, Code, bands>() with the widths of these rows.
template <class Function>
void with_widths(const formats::SparseRowsView& rows, std::uint32_t bands, const Function& f) {
    const auto with_code = [&]<class Index, class Code>() {
        bands == 1 ? f.template operator()<Index, Code, 1>()
                   : f.template operator()<Index, Code, 3>();
    };
    const auto with_index = [&]<class Index>() {
        rows.code_bits == 8 ? with_code.template operator()<Index, std::int8_t>()
                            : with_code.template operator()<Index, std::int16_t>();
    };
    rows.index_bytes == 2 ? with_index.template operator()<std::uint16_t>()
                          : with_index.template operator()<std::uint32_t>();
}

#if defined(__x86_64__)
/// Precondition: the processor has AVX2 and FMA.
void dot_rows_avx2(const formats::SparseRowsView& rows, const formats::RowRange& range,
                   const LightVector& light, std::uint32_t first, std::span<formats::Rgb> out);
/// Preconditions: the processor has AVX-512 F, BW and VL, FMA and BMI1; rows.index_bytes is 2.
void dot_rows_avx512(const formats::SparseRowsView& rows, const formats::RowRange& range,
                     const LightVector& light, std::uint32_t first, std::span<formats::Rgb> out);
#endif

}  // namespace opaline::runtime
