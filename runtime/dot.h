#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/rgb.h"
#include "formats/opal/sparse_rows.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Which instructions sum the products. Each path sums in one fixed order, so a row's result does
/// not depend on threads or on neighbouring rows; two paths differ by float rounding only:
/// by at most (details + 16) * 2^-23 * sum_i |T_i L_i| for a row.
enum class DotPath {
    scalar,  ///< the reference
    avx2,    ///< x86-64 with AVX2 and FMA
    avx512   ///< x86-64 with AVX-512 F, BW and VL, FMA and BMI1; rows of a cube map of N = 128 take
             ///< avx2
};

/// The fastest path that this processor can run.
DotPath best_dot_path();

/// out[i] = <T, L> for row first + i of the range: details and face averages, per colour band; grey
/// rows give L's colour. May be negative where truncation rings.
/// Preconditions: rows and light have the same cube map size; the rows lie inside the range and the
/// range inside `rows` (read_opal checks it). Never allocates.
void dot_rows(const formats::SparseRowsView& rows, const formats::RowRange& range,
              const LightVector& light, std::uint32_t first, std::span<formats::Rgb> out,
              DotPath path);

}  // namespace opaline::runtime
