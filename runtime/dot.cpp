#include "runtime/dot.h"

#include <array>

#include "formats/opal/detail_codes.h"
#include "runtime/dot_paths.h"
#include "runtime/vector_units.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

template <class Index, class Code, std::uint32_t bands>
void dot_scalar(const TypedRows<Index, Code>& rows, const LightVector& light, std::uint32_t first,
                std::span<Rgb> out) {
    const float* const l = light.rgba.data();
    const std::size_t face_stride = std::size_t{4} * light.n * light.n;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::size_t row = first + i;
        std::array<float, 3> details{}, sum{};
        const Code* code =
            rows.code + std::size_t{rows.row_offset[row] - rows.row_offset[0]} * bands;
        for (std::uint32_t d = rows.row_offset[row]; d < rows.row_offset[row + 1]; ++d) {
            const float* const at = l + std::size_t{4} * rows.index[d];
            for (std::size_t b = 0; b < 3; ++b) {
                details[b] +=
                    static_cast<float>(formats::detail_value(code[bands == 1 ? 0 : b])) * at[b];
            }
            code += bands;
        }
        for (std::size_t b = 0; b < 3; ++b) {
            const std::size_t band_row = row * bands + (bands == 1 ? 0 : b);
            float averages = 0;
            for (std::size_t face = 0; face < 6; ++face) {
                averages += static_cast<float>(rows.average_code[band_row * 6 + face]) *
                            l[face * face_stride + b];
            }
            sum[b] =
                details[b] * rows.detail_scale[band_row] + averages * rows.average_scale[band_row];
        }
        out[i] = {sum[0], sum[1], sum[2]};
    }
}

}  // namespace

DotPath best_dot_path() {
    const VectorUnits units = find_vector_units();
    if (units.avx512 && units.fma) return DotPath::avx512;
    return units.avx2 && units.fma ? DotPath::avx2 : DotPath::scalar;
}

void dot_rows(const formats::SparseRowsView& rows, const formats::RowRange& range,
              const LightVector& light, std::uint32_t first, std::span<Rgb> out, DotPath path) {
#if defined(__x86_64__)
    if (path == DotPath::avx512 && rows.index_bytes == 2) {
        dot_rows_avx512(rows, range, light, first, out);
        return;
    }
    if (path == DotPath::avx2 || path == DotPath::avx512) {
        dot_rows_avx2(rows, range, light, first, out);
        return;
    }
#endif
    static_cast<void>(path);
    with_widths(rows, range.bands, [&]<class Index, class Code, std::uint32_t bands>() {
        dot_scalar<Index, Code, bands>(typed_rows<Index, Code>(rows, range), light, first, out);
    });
}

}  // namespace opaline::runtime
