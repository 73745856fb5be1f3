#pragma once

namespace opaline::runtime {

/// What this processor computes with, and the operating system keeps for each thread. Asked by
/// CPUID: the compiler's own answer brings 4 kB of tables of processors into libopaline.so.
struct VectorUnits {
    bool avx2 = false;
    bool fma = false;
    /// Foundation, bytes and words, vectors of all lengths; and bit fields of integers (BMI1).
    bool avx512 = false;
};

/// All false but on x86-64. Any thread.
VectorUnits find_vector_units();

}  // namespace opaline::runtime
