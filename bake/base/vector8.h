#pragma once

#include <cstdint>
#include <cstring>

// The calling convention of these vectors depends on the instruction set, so all such functions are
// inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace opaline::bake {

/// Compiles a function for AVX-512, for AVX2 and for any machine; the loader chooses. All versions
/// give the same bits, because nothing is contracted or reassociated (-ffp-contract=off). Not used
/// under sanitizers, which start after the loader.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define OPALINE_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define OPALINE_VECTOR_CLONES
#endif

/// Forces inlining: the compiler inlines nothing into clones by itself, not even std::min.
#define OPALINE_INLINE [[gnu::always_inline]] inline

/// Eight numbers: one register, or two.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
constexpr std::uint32_t kVector = 8;

OPALINE_INLINE Float8 load8(const float* from) {
    Float8 v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

template <class Vector, class Number>
OPALINE_INLINE void store8(Vector v, Number* to) {
    static_assert(sizeof(Number) * kVector == sizeof v);
    __builtin_memcpy(to, &v, sizeof v);
}

OPALINE_INLINE Float8 all8(float x) {
    return Float8{x, x, x, x, x, x, x, x};
}

OPALINE_INLINE Float8 lesser8(Float8 a, Float8 b) {
    return a < b ? a : b;
}

OPALINE_INLINE Float8 greater8(Float8 a, Float8 b) {
    return a > b ? a : b;
}

OPALINE_INLINE Float8 gather8(const float* from, Int8 at) {
    return Float8{from[at[0]], from[at[1]], from[at[2]], from[at[3]],
                  from[at[4]], from[at[5]], from[at[6]], from[at[7]]};
}

OPALINE_INLINE float lesser(float a, float b) {
    return b < a ? b : a;
}

OPALINE_INLINE float greater(float a, float b) {
    return a < b ? b : a;
}

/// 1 / sqrt(x), x > 0 and not too small for a float to invert; relative error below 3e-7.
OPALINE_INLINE Float8 inverse_root8(Float8 x) {
    const Int8 guess = 0x5f375a86 - (reinterpret_cast<Int8>(x) >> 1);  // to 3.5 %
    Float8 y = reinterpret_cast<Float8>(guess);
    const Float8 half = 0.5f * x;
    y = y * (1.5f - half * y * y);
    y = y * (1.5f - half * y * y);
    y = y * (1.5f - half * y * y);
    return y;
}

/// True if all lanes of a comparison are true.
OPALINE_INLINE bool all_of8(Int8 mask) {
    std::int64_t half[4];
    __builtin_memcpy(half, &mask, sizeof half);
    return (half[0] & half[1] & half[2] & half[3]) == -1;
}

/// e^x for x <= 0: exp_of_negative in each lane.
OPALINE_INLINE Float8 exp_of_negative8(Float8 x) {
    constexpr float kLog2E = 1.44269504f, kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;
    const Float8 clamped = greater8(x, all8(-80.0f));
    const Int8 power = __builtin_convertvector(clamped * kLog2E - 0.5f, Int8);
    const Float8 k = __builtin_convertvector(power, Float8);
    const Float8 r = (clamped - k * kLn2High) - k * kLn2Low;
    Float8 e = all8(1.0f / 5040.0f);
    e = e * r + 1.0f / 720.0f;
    e = e * r + 1.0f / 120.0f;
    e = e * r + 1.0f / 24.0f;
    e = e * r + 1.0f / 6.0f;
    e = e * r + 0.5f;
    e = e * r + 1.0f;
    e = e * r + 1.0f;
    const Float8 scale = reinterpret_cast<Float8>((power + 127) << 23);
    return x < -80.0f ? all8(0.0f) : e * scale;
}

}  // namespace opaline::bake
