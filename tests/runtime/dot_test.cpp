#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "runtime/dot.h"
#include "runtime/vector_units.h"
#include "tests/runtime/row_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::RowRange;
using formats::SparseRows;
using tests::random_light;
using tests::random_rows;
using tests::whole_range;

struct Widths {
    std::uint32_t n, code_bits, bands;
};

std::vector<DotPath> paths() {
    std::vector<DotPath> all{DotPath::scalar};
    for (const DotPath path : {DotPath::avx2, DotPath::avx512}) {
        if (path <= best_dot_path()) all.push_back(path);
    }
    return all;
}

class DotRows : public testing::TestWithParam<Widths> {};

// The decoded row times the light, in double precision.
TEST_P(DotRows, EqualsTheDecodedRowTimesTheLight) {
    const auto [n, code_bits, bands] = GetParam();
    const SparseRows rows = random_rows(n, code_bits, bands, 1);
    const RowRange range = whole_range(rows, bands);
    const LightVector light = random_light(n, 2);
    std::vector<float> dense(formats::cubemap_texels(n));
    for (const DotPath path : paths()) {
        std::vector<Rgb> out(range.rows);
        dot_rows(rows.view(), range, light, 0, out, path);
        for (std::uint32_t r = 0; r < range.rows; ++r) {
            const std::array<float, 3> found{out[r].r, out[r].g, out[r].b};
            for (std::uint32_t b = 0; b < 3; ++b) {
                formats::decode_row(rows.view(), range, r, bands == 1 ? 0 : b, dense);
                double sum = 0, magnitude = 0;
                for (std::size_t k = 0; k < dense.size(); ++k) {
                    sum += double{dense[k]} * double{light.rgba[4 * k + b]};
                    magnitude += std::abs(double{dense[k]} * double{light.rgba[4 * k + b]});
                }
                // Rounding of at most details + 16 operations (dot.h), half of it for one path.
                ASSERT_NEAR(found[b], sum, (r + 16) * std::ldexp(magnitude, -24)) << "row " << r;
            }
        }
    }
}

TEST_P(DotRows, ARowDoesNotDependOnWhereTheRangeIsCut) {
    const auto [n, code_bits, bands] = GetParam();
    const SparseRows rows = random_rows(n, code_bits, bands, 3);
    const RowRange range = whole_range(rows, bands);
    const LightVector light = random_light(n, 4);
    for (const DotPath path : paths()) {
        std::vector<Rgb> whole(range.rows), pieces(range.rows);
        dot_rows(rows.view(), range, light, 0, whole, path);
        for (std::uint32_t first = 0; first < range.rows; first += 5) {
            const std::uint32_t count = std::min(5u, range.rows - first);
            dot_rows(rows.view(), range, light, first, std::span(pieces).subspan(first, count),
                     path);
        }
        EXPECT_EQ(whole, pieces);
    }
}

INSTANTIATE_TEST_SUITE_P(Widths, DotRows,
                         testing::Values(Widths{8, 8, 1}, Widths{8, 8, 3}, Widths{32, 16, 1},
                                         Widths{32, 16, 3}, Widths{128, 8, 1}, Widths{128, 8, 3},
                                         Widths{128, 16, 1}, Widths{128, 16, 3}),
                         [](const auto& width) {
                             return "n" + std::to_string(width.param.n) + "_bits" +
                                    std::to_string(width.param.code_bits) + "_bands" +
                                    std::to_string(width.param.bands);
                         });

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
