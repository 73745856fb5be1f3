#include "runtime/dot_paths.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <cstring>

#include "formats/opal/cubemap.h"
#include "formats/opal/detail_codes.h"

// Four coefficients share a 512-bit register: (r g b 0) of each, multiplied by their codes spread
// over the lanes. Only functions marked here use AVX-512.
#define OPALINE_AVX512 __attribute__((target("avx512f,avx512bw,avx512vl,fma,bmi")))

namespace opaline::runtime {
namespace {

using formats::Rgb;

// Rows are read once, in order, as in dot_avx2.cpp.
template <class T>
OPALINE_AVX512 inline void prefetch_ahead(const T* p) {
    constexpr std::uintptr_t kAhead = 2048;
    // Past the end of the array perhaps, where no pointer may be formed by addition.
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    _mm_prefetch(reinterpret_cast<const char*>(reinterpret_cast<std::uintptr_t>(p) + kAhead),
                 _MM_HINT_T0);
}

// Broadcasts under a mask: loads alone, where inserts would take the shuffling unit too.
OPALINE_AVX512 inline __m512 join_four(const float* first, const float* second, const float* third,
                                       const float* fourth) {
    __m512 v = _mm512_castps128_ps512(_mm_loadu_ps(first));
    v = _mm512_mask_broadcast_f32x4(v, 0x00f0, _mm_loadu_ps(second));
    v = _mm512_mask_broadcast_f32x4(v, 0x0f00, _mm_loadu_ps(third));
    return _mm512_mask_broadcast_f32x4(v, 0xf000, _mm_loadu_ps(fourth));
}

// The four indices are one load as well, and are told apart in one instruction each: this loop is
// short of instructions. They are doubled, all at once, because addresses scale by eight bytes at
// most and a coefficient of the light has sixteen: what has indices of 16 bits has N = 64 at most,
// so none carries.
OPALINE_AVX512 inline __m512 load_four(const float* light, const std::uint16_t* index) {
    static_assert(6 * (formats::kMaxCubemapSize / 2) * (formats::kMaxCubemapSize / 2) <= 1U << 15U);
    std::uint64_t all = 0;
    std::memcpy(&all, index, sizeof all);
    all += all;
    return join_four(light + 2 * (all & 0xffff), light + 2 * _bextr_u64(all, 16, 16),
                     light + 2 * _bextr_u64(all, 32, 16), light + 2 * (all >> 48));
}

// What codes stand for (detail_codes.h).
OPALINE_AVX512 inline __m512 values_of(__m128i codes) {
    const __m256i c = _mm256_cvtepi8_epi16(codes);
    return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(_mm256_mullo_epi16(c, _mm256_abs_epi16(c))));
}
OPALINE_AVX512 inline __m512 values_of(__m256i codes) {
    return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(codes));
}

OPALINE_AVX512 inline __m512 sixteen_values(const std::int8_t* code) {
    return values_of(_mm_loadu_si128(reinterpret_cast<const __m128i*>(code)));
}
OPALINE_AVX512 inline __m512 sixteen_values(const std::int16_t* code) {
    return values_of(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(code)));
}

// Of four codes, in the first lanes.
OPALINE_AVX512 inline __m512 four_values(const std::int8_t* code) {
    std::int32_t four = 0;
    std::memcpy(&four, code, sizeof four);
    return values_of(_mm_cvtsi32_si128(four));
}
OPALINE_AVX512 inline __m512 four_values(const std::int16_t* code) {
    return values_of(
        _mm256_zextsi128_si256(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(code))));
}

// Twelve bytes, not one more: codes may end where the file's mapping ends.
OPALINE_AVX512 inline __m128i load_twelve_bytes(const void* p) {
    return _mm_maskz_loadu_epi32(0x7, p);
}

// Values of four RGB details as (r g b 0) each.
OPALINE_AVX512 inline __m512 four_colors(const std::int8_t* code) {
    const __m128i gaps = _mm_setr_epi8(0, 1, 2, -1, 3, 4, 5, -1, 6, 7, 8, -1, 9, 10, 11, -1);
    return values_of(_mm_shuffle_epi8(load_twelve_bytes(code), gaps));
}
OPALINE_AVX512 inline __m512 four_colors(const std::int16_t* code) {
    const __m128i gaps = _mm_setr_epi8(0, 1, 2, 3, 4, 5, -1, -1, 6, 7, 8, 9, 10, 11, -1, -1);
    const __m128i low = _mm_shuffle_epi8(load_twelve_bytes(code), gaps);
    const __m128i high = _mm_shuffle_epi8(load_twelve_bytes(code + 6), gaps);
    return values_of(_mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1));
}

// Spreads the first four values over four lanes each.
OPALINE_AVX512 inline __m512 spread_four(__m512 values) {
    return _mm512_permutexvar_ps(_mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3),
                                 values);
}

// What four details are multiplied by.
template <std::uint32_t bands, class Code>
OPALINE_AVX512 inline __m512 four_factors(const Code* code) {
    if constexpr (bands == 1) return spread_four(four_values(code));
    return four_colors(code);
}

template <class Code>
OPALINE_AVX512 inline __m128 color_of(const Code* code, std::uint32_t bands) {
    const auto value = [code](std::uint32_t i) {
        return static_cast<float>(formats::detail_value(code[i]));
    };
    return bands == 1 ? _mm_set1_ps(value(0)) : _mm_setr_ps(value(0), value(1), value(2), 0.0f);
}

OPALINE_AVX512 inline __m128 add_quarters(__m512 v) {
    const __m256 half =
        _mm256_add_ps(_mm512_castps512_ps256(v),
                      _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(v), 1)));
    return _mm_add_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
}

// sum code * light over the details of a row.
template <class Code, std::uint32_t bands>
OPALINE_AVX512 inline __m128 sum_details(const float* light, const std::uint16_t* index,
                                         const Code* code, std::uint32_t count) {
    __m512 s0 = _mm512_setzero_ps(), s1 = s0, s2 = s0, s3 = s0;
    std::uint32_t i = 0;
    for (; i + 16 <= count; i += 16) {
        const Code* const c = code + std::size_t{bands} * i;
        prefetch_ahead(index + i);
        prefetch_ahead(c);
        __m512 c0, c1, c2, c3;
        if constexpr (bands == 1) {
            const __m512 all = sixteen_values(c);
            const __m512i first = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
            const __m512i four = _mm512_set1_epi32(4), second = _mm512_add_epi32(first, four),
                          third = _mm512_add_epi32(second, four);
            c0 = _mm512_permutexvar_ps(first, all);
            c1 = _mm512_permutexvar_ps(second, all);
            c2 = _mm512_permutexvar_ps(third, all);
            c3 = _mm512_permutexvar_ps(_mm512_add_epi32(third, four), all);
        } else {
            c0 = four_colors(c);
            c1 = four_colors(c + 12);
            c2 = four_colors(c + 24);
            c3 = four_colors(c + 36);
        }
        s0 = _mm512_fmadd_ps(load_four(light, index + i), c0, s0);
        s1 = _mm512_fmadd_ps(load_four(light, index + i + 4), c1, s1);
        s2 = _mm512_fmadd_ps(load_four(light, index + i + 8), c2, s2);
        s3 = _mm512_fmadd_ps(load_four(light, index + i + 12), c3, s3);
    }
    for (; i + 4 <= count; i += 4) {
        const Code* const c = code + std::size_t{bands} * i;
        s0 = _mm512_fmadd_ps(load_four(light, index + i), four_factors<bands>(c), s0);
    }
    __m128 rest = _mm_setzero_ps();
    for (; i < count; ++i) {
        rest = _mm_fmadd_ps(_mm_loadu_ps(light + std::size_t{4} * index[i]),
                            color_of(code + std::size_t{bands} * i, bands), rest);
    }
    return _mm_add_ps(add_quarters(_mm512_add_ps(_mm512_add_ps(s0, s1), _mm512_add_ps(s2, s3))),
                      rest);
}

// Face averages of the light, the same for all rows: (r g b 0) of four faces, then of two.
struct FacesOfLight {
    __m512 four;
    __m256 two;
};

OPALINE_AVX512 inline FacesOfLight faces_of(const LightVector& light) {
    const float* const l = light.rgba.data();
    const std::size_t stride = std::size_t{4} * light.n * light.n;
    const __m256 two = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(l + 4 * stride)),
                                            _mm_loadu_ps(l + 5 * stride), 1);
    return {join_four(l, l + stride, l + 2 * stride, l + 3 * stride), two};
}

OPALINE_AVX512 inline __m128 add_faces(const FacesOfLight& faces, __m512 four, __m256 two) {
    const __m256 sum = _mm256_mul_ps(faces.two, two);
    return add_quarters(_mm512_fmadd_ps(faces.four, four, _mm512_zextps256_ps512(sum)));
}

// `code`: six averages of red, then of green, then of blue; of grey rows six.
template <std::uint32_t bands>
OPALINE_AVX512 inline __m128 sum_averages(const FacesOfLight& faces, const std::int16_t* code) {
    if constexpr (bands == 1) {
        const __m256 c = _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(load_twelve_bytes(code)));
        return add_faces(faces, spread_four(_mm512_castps256_ps512(c)),
                         _mm256_permutexvar_ps(_mm256_setr_epi32(4, 4, 4, 4, 5, 5, 5, 5), c));
    } else {
        const __m512 c = _mm512_cvtepi32_ps(
            _mm512_cvtepi16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(code))));
        const __m512i first = _mm512_setr_epi32(0, 6, 12, 0, 1, 7, 13, 0, 2, 8, 14, 0, 3, 9, 15, 0);
        const __m512i last = _mm512_setr_epi32(4, 10, 16, 0, 5, 11, 17, 0, 0, 0, 0, 0, 0, 0, 0, 0);
        const __m128i rest = _mm_cvtepi16_epi32(_mm_maskz_loadu_epi16(0x3, code + 16));
        const __m512 end = _mm512_castps128_ps512(_mm_cvtepi32_ps(rest));
        return add_faces(faces, _mm512_maskz_permutexvar_ps(0x7777, first, c),
                         _mm512_castps512_ps256(_mm512_maskz_permutex2var_ps(0x77, c, last, end)));
    }
}

// Of each band; the fourth lane is not stored.
template <std::uint32_t bands>
OPALINE_AVX512 inline __m128 scale_of(const float* scale) {
    return bands == 1 ? _mm_set1_ps(*scale) : _mm_maskz_loadu_ps(0x7, scale);
}

template <class Code, std::uint32_t bands>
OPALINE_AVX512 void dot_wide(const TypedRows<std::uint16_t, Code>& rows, const LightVector& light,
                             std::uint32_t first, std::span<Rgb> out) {
    const float* const l = light.rgba.data();
    const FacesOfLight faces = faces_of(light);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::size_t row = first + i;
        const std::uint32_t begin = rows.row_offset[row];
        const __m128 details = sum_details<Code, bands>(
            l, rows.index + begin, rows.code + std::size_t{begin - rows.row_offset[0]} * bands,
            rows.row_offset[row + 1] - begin);
        const __m128 averages = sum_averages<bands>(faces, rows.average_code + row * bands * 6);
        const __m128 detail_scale = scale_of<bands>(rows.detail_scale + row * bands);
        const __m128 average_scale = scale_of<bands>(rows.average_scale + row * bands);
        const __m128 sum = _mm_fmadd_ps(details, detail_scale, _mm_mul_ps(averages, average_scale));
        _mm_mask_storeu_ps(&out[i].r, 0x7, sum);
    }
}

}  // namespace

void dot_rows_avx512(const formats::SparseRowsView& rows, const formats::RowRange& range,
                     const LightVector& light, std::uint32_t first, std::span<Rgb> out) {
    const auto dot = [&]<class Code, std::uint32_t bands>() {
        dot_wide<Code, bands>(typed_rows<std::uint16_t, Code>(rows, range), light, first, out);
    };
    if (rows.code_bits == 8) {
        range.bands == 1 ? dot.template operator()<std::int8_t, 1>()
                         : dot.template operator()<std::int8_t, 3>();
    } else {
        range.bands == 1 ? dot.template operator()<std::int16_t, 1>()
                         : dot.template operator()<std::int16_t, 3>();
    }
}

}  // namespace opaline::runtime

#endif
