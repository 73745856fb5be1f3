#include "runtime/vector_units.h"

#include <cstdint>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace opaline::runtime {
namespace {

VectorUnits ask_processor() {
    VectorUnits units;
#if defined(__x86_64__)
    constexpr std::uint32_t kFma = 1u << 12, kSavesState = 1u << 27;             // leaf 1, ECX
    constexpr std::uint32_t kAvx2 = 1u << 5;                                     // leaf 7, EBX
    constexpr std::uint32_t kAvx512 = 1u << 3 | 1u << 16 | 1u << 30 | 1u << 31;  // BMI1, F, BW, VL
    constexpr std::uint32_t kKeepsYmm = 1u << 1 | 1u << 2;                       // XCR0
    constexpr std::uint32_t kKeepsZmm = kKeepsYmm | 1u << 5 | 1u << 6 | 1u << 7;
    std::uint32_t a = 0, b = 0, c = 0, d = 0;
    if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & kSavesState) == 0) return units;
    const bool has_fma = (c & kFma) != 0;
    std::uint32_t kept = 0, above = 0;
    __asm__ volatile("xgetbv" : "=a"(kept), "=d"(above) : "c"(0));
    if ((kept & kKeepsYmm) != kKeepsYmm || __get_cpuid_count(7, 0, &a, &b, &c, &d) == 0) {
        return units;
    }
    units.fma = has_fma;
    units.avx2 = (b & kAvx2) != 0;
    units.avx512 = (kept & kKeepsZmm) == kKeepsZmm && (b & kAvx512) == kAvx512;
#endif
    return units;
}

}  // namespace

VectorUnits find_vector_units() {
    // Virtual machines take microseconds to answer.
    static const VectorUnits units = ask_processor();
    return units;
}

}  // namespace opaline::runtime
