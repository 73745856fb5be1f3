#include "runtime/vector_units.h"

#include <gtest/gtest.h>

namespace opaline::runtime {
namespace {

TEST(VectorUnits, AreThoseThatTheCompilerFinds) {
    const VectorUnits found = find_vector_units();
#if defined(__x86_64__)
    __builtin_cpu_init();
    EXPECT_EQ(found.avx2, __builtin_cpu_supports("avx2") != 0);
    EXPECT_EQ(found.fma, __builtin_cpu_supports("fma") != 0);
    EXPECT_EQ(found.avx512, __builtin_cpu_supports("avx512f") != 0 &&
                                __builtin_cpu_supports("avx512bw") != 0 &&
                                __builtin_cpu_supports("avx512vl") != 0);
#else
    EXPECT_FALSE(found.avx2 || found.fma || found.avx512);
#endif
}

}  // namespace
}  // namespace opaline::runtime
