#pragma once

#include <cstdint>
#include <cstring>

#include "runtime/vector_units.h"

namespace opaline::runtime {

/// Several floats in registers. Each operation rounds every lane as a float by itself and nothing
/// is contracted, so results have the same bits whatever the width.
typedef float Float8 __attribute__((vector_size(32)));
typedef std::int32_t Int8 __attribute__((vector_size(32)));
typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));
typedef double Double4 __attribute__((vector_size(32)));

/// How many: eight with AVX2, four with SSE2 or NEON.
struct Lanes8 {
    using Float = Float8;
    using Int = Int8;
    static constexpr std::size_t kCount = 8;
};
struct Lanes4 {
    using Float = Float4;
    using Int = Int4;
    static constexpr std::size_t kCount = 4;
};

#define OPALINE_ALWAYS_INLINE __attribute__((always_inline)) inline

#if defined(__x86_64__)
template <class Work>
__attribute__((target("avx2"))) void run_with_avx2(const Work& work) {
    work(Lanes8{});
}
#endif

/// Calls work(Lanes8{}), compiled for AVX2, where this processor has it, or else work(Lanes4{}).
/// `work` and all that it calls on vectors must be inlined (OPALINE_ALWAYS_INLINE).
template <class Work>
void run_wide(const Work& work) {
#if defined(__x86_64__)
    if (find_vector_units().avx2) {
        run_with_avx2(work);
        return;
    }
#endif
    work(Lanes4{});
}

// Vectors are passed by reference: by value, their calling convention depends on the target.

/// Sets lanes to 0, 1, 2 ...
OPALINE_ALWAYS_INLINE void number_lanes(Float4& out) {
    out = Float4{0, 1, 2, 3};
}
OPALINE_ALWAYS_INLINE void number_lanes(Float8& out) {
    out = Float8{0, 1, 2, 3, 4, 5, 6, 7};
}

/// 1 / sqrt(x) to 2^-22, for x in [0, 1e37]; a large finite number for 0.
template <class L>
OPALINE_ALWAYS_INLINE void reciprocal_root(L, const typename L::Float& x, typename L::Float& out) {
    typename L::Int bits;
    std::memcpy(&bits, &x, sizeof bits);
    bits = 0x5f3759df - (bits >> 1);
    typename L::Float y;
    std::memcpy(&y, &bits, sizeof y);
    const typename L::Float half = 0.5f * x;
    y = y * (1.5f - half * y * y);
    y = y * (1.5f - half * y * y);
    out = y * (1.5f - half * y * y);
}

/// atan2(y, x) to 3e-7; 0 for (0, 0).
template <class L>
OPALINE_ALWAYS_INLINE void arc_tangent(L, const typename L::Float& y, const typename L::Float& x,
                                       typename L::Float& out) {
    using Float = typename L::Float;
    const Float zero = {};
    const Float ax = x < 0 ? -x : x, ay = y < 0 ? -y : y;
    const Float low = ax < ay ? ax : ay, high = ax < ay ? ay : ax;
    // Above tan(pi / 8): atan(t) = pi / 4 + atan((t - 1) / (t + 1)). Polynomial: Cephes, atanf.
    const typename L::Int upper = low > 0.4142135624f * high;
    const Float numerator = upper ? low - high : low;
    const Float denominator = upper ? low + high : high;
    const Float t = numerator / (denominator == 0 ? zero + 1 : denominator), z = t * t;
    Float angle = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z -
                   3.33329491539e-1f) *
                      z * t +
                  t;
    angle = upper ? angle + 0.785398163397448f : angle;
    angle = ay > ax ? 1.57079632679489662f - angle : angle;
    angle = x < 0 ? 3.14159265358979324f - angle : angle;
    out = y < 0 ? -angle : angle;
}

}  // namespace opaline::runtime
