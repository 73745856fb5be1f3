#include "bake/trace/coded_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/base/rng.h"

namespace opaline::bake {
namespace {

// Its largest value is the last one, behind all whole blocks of 16.
std::vector<float> row_of(std::size_t size, float scale) {
    std::vector<float> row(size);
    for (std::size_t k = 0; k < size; ++k) {
        const auto u = random_uniform(1, RandomStage::bounce_rays, k);
        row[k] = scale * (u[0] - 0.5f);
    }
    row.back() = -scale;
    return row;
}

TEST(CodedRows, AreOffByHalfAStepOf32767) {
    for (const std::size_t size : {1u, 15u, 16u, 19u, 1152u}) {
        for (const float scale : {1e-30f, 1e-3f, 1.0f, 1e6f, 1e30f}) {
            CodedRows rows(2, size);
            const std::vector<float> row = row_of(size, scale);
            rows.set(1, row);
            const std::vector<float> read = rows.row(1);
            for (std::size_t k = 0; k < size; ++k) {
                EXPECT_NEAR(read[k] / scale, row[k] / scale, 1.6e-5) << size << " " << k;
                EXPECT_EQ(rows.value(1, k), read[k]);
            }
            EXPECT_EQ(rows.row(0), std::vector<float>(size)) << "the other row stays 0";
        }
    }
}

TEST(CodedRows, AddUpWithTheirWeights) {
    const std::vector<float> first = row_of(40, 1), second = row_of(40, 100);
    std::vector<float> both = first;
    both.insert(both.end(), second.begin(), second.end());
    const CodedRows rows(both, 40);
    ASSERT_EQ(rows.count(), 2u);
    std::vector<float> sum(40, 3);
    rows.add(0, 2, sum);
    rows.add(1, -0.5f, sum);
    for (std::size_t k = 0; k < 40; ++k) {
        EXPECT_NEAR(sum[k], 3 + 2 * first[k] - 0.5f * second[k], 1e-3);
    }
}

TEST(CodedRows, DarknessBelowAllScalesIsFinite) {
    CodedRows rows(1, 3);
    rows.set(0, std::vector<float>{1e-40f, -1e-42f, 0});
    for (const float value : rows.row(0)) {
        EXPECT_TRUE(std::isfinite(value));
        EXPECT_LT(std::abs(value), 1e-37f);
    }
}

}  // namespace
}  // namespace opaline::bake
