#include "runtime/dot_paths.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <cstring>

#include "formats/opal/detail_codes.h"

// Two coefficients share a 256-bit register: (r g b 0) of one in the low half, of the next in the
// high half, multiplied by their codes spread over the lanes. Only functions marked here use AVX2,
// so nothing that another file may link against does.
#define OPALINE_AVX2 __attribute__((target("avx2,fma")))

namespace opaline::runtime {
namespace {

using formats::Rgb;

// Rows are read once, in order; the light's scattered reads keep the processor from running far
// enough ahead by itself. A prefetch past the end does nothing.
template <class T>
OPALINE_AVX2 inline void prefetch(const T* p) {
    constexpr std::uintptr_t kAhead = 2048;
    _mm_prefetch(reinterpret_cast<const char*>(reinterpret_cast<std::uintptr_t>(p) + kAhead),
                 _MM_HINT_T0);
}

template <class Index>
OPALINE_AVX2 inline __m256 load_pair(const float* light, Index first, Index second) {
    const __m128 low = _mm_loadu_ps(light + std::size_t{4} * first);
    const __m128 high = _mm_loadu_ps(light + std::size_t{4} * second);
    return _mm256_insertf128_ps(_mm256_castps128_ps256(low), high, 1);
}

// Spreads value i over the lower and value i + 4 over the upper four lanes. Within halves, because
// moving lanes between them takes twice as long.
template <int i>
OPALINE_AVX2 inline __m256 spread_in_halves(__m256 values) {
    return _mm256_permute_ps(values, i * 0x55);
}

// Spreads values 2 pair and 2 pair + 1 over the lower and the upper four lanes.
template <int pair>
OPALINE_AVX2 inline __m256 spread(__m256 values) {
    constexpr int a = 2 * pair, b = 2 * pair + 1;
    return _mm256_permutevar8x32_ps(values, _mm256_setr_epi32(a, a, a, a, b, b, b, b));
}

OPALINE_AVX2 inline __m128 add_halves(__m256 v) {
    return _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
}

// Twelve bytes, not one more: codes may end where the file's mapping ends.
OPALINE_AVX2 inline __m128i load_12_bytes(const void* p) {
    std::int32_t last = 0;
    std::memcpy(&last, static_cast<const char*>(p) + 8, sizeof last);
    return _mm_insert_epi32(_mm_loadl_epi64(static_cast<const __m128i*>(p)), last, 2);
}

// What they stand for (detail_codes.h).
OPALINE_AVX2 inline __m256 eight_values(const std::int8_t* code) {
    const __m128i c = _mm_cvtepi8_epi16(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(code)));
    return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_mullo_epi16(c, _mm_abs_epi16(c))));
}
OPALINE_AVX2 inline __m256 eight_values(const std::int16_t* code) {
    return _mm256_cvtepi32_ps(
        _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(code))));
}

// sum code * light over the details of a grey row.
template <class Index, class Code>
OPALINE_AVX2 inline __m128 sum_grey(const float* light, const Index* index, const Code* code,
                                    std::uint32_t count) {
    __m256 s0 = _mm256_setzero_ps(), s1 = s0, s2 = s0, s3 = s0;
    std::uint32_t i = 0;
    for (; i + 8 <= count; i += 8) {
        prefetch(index + i);
        prefetch(code + i);
        const __m256 c = eight_values(code + i);
        s0 = _mm256_fmadd_ps(load_pair(light, index[i], index[i + 4]), spread_in_halves<0>(c), s0);
        s1 = _mm256_fmadd_ps(load_pair(light, index[i + 1], index[i + 5]), spread_in_halves<1>(c),
                             s1);
        s2 = _mm256_fmadd_ps(load_pair(light, index[i + 2], index[i + 6]), spread_in_halves<2>(c),
                             s2);
        s3 = _mm256_fmadd_ps(load_pair(light, index[i + 3], index[i + 7]), spread_in_halves<3>(c),
                             s3);
    }
    __m128 rest = _mm_setzero_ps();
    for (; i < count; ++i) {
        rest = _mm_fmadd_ps(_mm_loadu_ps(light + std::size_t{4} * index[i]),
                            _mm_set1_ps(static_cast<float>(formats::detail_value(code[i]))), rest);
    }
    const __m256 sum = _mm256_add_ps(_mm256_add_ps(s0, s1), _mm256_add_ps(s2, s3));
    return _mm_add_ps(add_halves(sum), rest);
}

// Values of four RGB details as two registers of (r g b 0 r g b 0).
struct FourDetails {
    __m256 first, second;
};
OPALINE_AVX2 inline FourDetails four_details(const std::int8_t* code) {
    const __m128i gaps = _mm_setr_epi8(0, 1, 2, -1, 3, 4, 5, -1, 6, 7, 8, -1, 9, 10, 11, -1);
    const __m256i codes = _mm256_cvtepi8_epi16(_mm_shuffle_epi8(load_12_bytes(code), gaps));
    const __m256i values = _mm256_mullo_epi16(codes, _mm256_abs_epi16(codes));
    return {_mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm256_castsi256_si128(values))),
            _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm256_extracti128_si256(values, 1)))};
}
OPALINE_AVX2 inline FourDetails four_details(const std::int16_t* code) {
    const __m128i gaps = _mm_setr_epi8(0, 1, 2, 3, 4, 5, -1, -1, 6, 7, 8, 9, 10, 11, -1, -1);
    const __m128i low = _mm_shuffle_epi8(load_12_bytes(code), gaps);
    const __m128i high = _mm_shuffle_epi8(load_12_bytes(code + 6), gaps);
    return {_mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(low)),
            _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(high))};
}

OPALINE_AVX2 inline __m128 three_floats(const float* v) {
    return _mm_setr_ps(v[0], v[1], v[2], 0.0f);
}
template <class Code>
OPALINE_AVX2 inline __m128 three_values(const Code* code) {
    return _mm_setr_ps(static_cast<float>(formats::detail_value(code[0])),
                       static_cast<float>(formats::detail_value(code[1])),
                       static_cast<float>(formats::detail_value(code[2])), 0.0f);
}

template <class Index, class Code>
OPALINE_AVX2 inline __m128 sum_rgb(const float* light, const Index* index, const Code* code,
                                   std::uint32_t count) {
    __m256 s0 = _mm256_setzero_ps(), s1 = s0, s2 = s0, s3 = s0;
    std::uint32_t i = 0;
    for (; i + 8 <= count; i += 8) {
        prefetch(index + i);
        prefetch(code + std::size_t{3} * i);
        const FourDetails a = four_details(code + std::size_t{3} * i);
        const FourDetails b = four_details(code + std::size_t{3} * i + 12);
        s0 = _mm256_fmadd_ps(load_pair(light, index[i], index[i + 1]), a.first, s0);
        s1 = _mm256_fmadd_ps(load_pair(light, index[i + 2], index[i + 3]), a.second, s1);
        s2 = _mm256_fmadd_ps(load_pair(light, index[i + 4], index[i + 5]), b.first, s2);
        s3 = _mm256_fmadd_ps(load_pair(light, index[i + 6], index[i + 7]), b.second, s3);
    }
    __m128 rest = _mm_setzero_ps();
    for (; i < count; ++i) {
        rest = _mm_fmadd_ps(_mm_loadu_ps(light + std::size_t{4} * index[i]),
                            three_values(code + std::size_t{3} * i), rest);
    }
    const __m256 sum = _mm256_add_ps(_mm256_add_ps(s0, s1), _mm256_add_ps(s2, s3));
    return _mm_add_ps(add_halves(sum), rest);
}

// Face averages of the light, two faces a register; the same for all rows.
struct FaceAverages {
    __m256 pair[3];
};

OPALINE_AVX2 inline __m128 sum_averages_grey(const FaceAverages& faces, const std::int16_t* code) {
    const __m256 c = _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(load_12_bytes(code)));
    __m256 sum = _mm256_mul_ps(faces.pair[0], spread<0>(c));
    sum = _mm256_fmadd_ps(faces.pair[1], spread<1>(c), sum);
    sum = _mm256_fmadd_ps(faces.pair[2], spread<2>(c), sum);
    return add_halves(sum);
}

// `code`: six averages of red, then of green, then of blue.
OPALINE_AVX2 inline __m128 sum_averages_rgb(const FaceAverages& faces, const std::int16_t* code) {
    __m256 sum = _mm256_setzero_ps();
    for (int p = 0; p < 3; ++p) {
        const std::int16_t* c = code + 2 * p;
        const __m256i codes = _mm256_setr_epi32(c[0], c[6], c[12], 0, c[1], c[7], c[13], 0);
        sum = _mm256_fmadd_ps(faces.pair[p], _mm256_cvtepi32_ps(codes), sum);
    }
    return add_halves(sum);
}

OPALINE_AVX2 inline void store_rgb(Rgb& to, __m128 v) {
    _mm_storel_pi(reinterpret_cast<__m64*>(&to.r), v);
    _mm_store_ss(&to.b, _mm_movehl_ps(v, v));
}

template <class Index, class Code, std::uint32_t bands>
OPALINE_AVX2 void dot_typed(const TypedRows<Index, Code>& rows, const LightVector& light,
                            std::uint32_t first, std::span<Rgb> out) {
    const float* const l = light.rgba.data();
    const std::uint32_t face_size = light.n * light.n;
    FaceAverages faces;
    for (std::uint32_t p = 0; p < 3; ++p) {
        faces.pair[p] = load_pair(l, 2 * p * face_size, (2 * p + 1) * face_size);
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::size_t row = first + i;
        const std::uint32_t begin = rows.row_offset[row];
        const std::uint32_t count = rows.row_offset[row + 1] - begin;
        const Index* const index = rows.index + begin;
        const Code* const code = rows.code + std::size_t{begin - rows.row_offset[0]} * bands;
        __m128 details, averages, detail_scale, average_scale;
        if constexpr (bands == 1) {
            details = sum_grey(l, index, code, count);
            averages = sum_averages_grey(faces, rows.average_code + row * 6);
            detail_scale = _mm_set1_ps(rows.detail_scale[row]);
            average_scale = _mm_set1_ps(rows.average_scale[row]);
        } else {
            details = sum_rgb(l, index, code, count);
            averages = sum_averages_rgb(faces, rows.average_code + row * 18);
            detail_scale = three_floats(rows.detail_scale + row * 3);
            average_scale = three_floats(rows.average_scale + row * 3);
        }
        store_rgb(out[i], _mm_fmadd_ps(details, detail_scale, _mm_mul_ps(averages, average_scale)));
    }
}

}  // namespace

void dot_rows_avx2(const formats::SparseRowsView& rows, const formats::RowRange& range,
                   const LightVector& light, std::uint32_t first, std::span<Rgb> out) {
    with_widths(rows, range.bands, [&]<class Index, class Code, std::uint32_t bands>() {
        dot_typed<Index, Code, bands>(typed_rows<Index, Code>(rows, range), light, first, out);
    });
}

}  // namespace opaline::runtime

#endif
