#include "bake/encode/select_coefficients.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSize = 16;

std::vector<float> random_coefficients(std::uint32_t bands) {
    std::mt19937 generator(4);
    std::cauchy_distribution<float> heavy_tailed;
    std::vector<float> values(bands * formats::cubemap_texels(kSize));
    for (float& value : values) {
        value = heavy_tailed(generator);
    }
    return values;
}

double energy(const std::vector<float>& values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

TEST(SelectCoefficients, AllOfThemReproduceTheRow) {
    const std::vector<float> dense = random_coefficients(1);
    const auto row = select_coefficients(make_selector(kSize, 0xffffffffu), dense, 1);
    ASSERT_EQ(row.index.size() + 6, dense.size());
    for (std::size_t i = 0; i < row.index.size(); ++i) {
        ASSERT_EQ(row.value[i], dense[row.index[i]]);
    }
    for (std::size_t face = 0; face < 6; ++face) {
        ASSERT_EQ(row.average[face], dense[face * kSize * kSize]);
    }
}

// With beta = 0 the kept set is the L2-best of its size: no dropped value exceeds a kept one.
TEST(SelectCoefficients, WithoutPriorTheLargestAreKept) {
    const std::vector<float> dense = random_coefficients(1);
    const auto row = select_coefficients(make_selector(kSize, 70, 0), dense, 1);
    ASSERT_EQ(row.index.size(), 64u);
    float smallest_kept = 1e30f;
    for (const float value : row.value) {
        smallest_kept = std::min(smallest_kept, std::abs(value));
    }
    std::size_t larger = 0;
    for (std::size_t k = 0; k < dense.size(); ++k) {
        larger += k % (kSize * kSize) != 0 && std::abs(dense[k]) > smallest_kept ? 1 : 0;
    }
    EXPECT_EQ(larger, 63u);
}

TEST(SelectCoefficients, KeptEnergyGrowsWithTheirNumber) {
    const std::vector<float> dense = random_coefficients(1);
    double previous = -1;
    for (const std::uint32_t kept : {8u, 16u, 64u, 256u, 1024u}) {
        const auto row = select_coefficients(make_selector(kSize, kept), dense, 1);
        EXPECT_EQ(row.index.size() + row.average.size(), kept);
        const double e = energy(row.value) + energy(row.average);
        EXPECT_GT(e, previous);
        previous = e;
    }
    EXPECT_LE(previous, energy(dense) * (1 + 1e-12));
}

TEST(SelectCoefficients, BandsShareOneAscendingIndexSet) {
    const std::vector<float> dense = random_coefficients(3);
    const auto row = select_coefficients(make_selector(kSize, 100), dense, 3);
    ASSERT_EQ(row.value.size(), 3 * row.index.size());
    const std::size_t size = formats::cubemap_texels(kSize);
    for (std::size_t i = 0; i < row.index.size(); ++i) {
        ASSERT_TRUE(i == 0 || row.index[i - 1] < row.index[i]);
        for (std::size_t band = 0; band < 3; ++band) {
            ASSERT_EQ(row.value[band * row.index.size() + i], dense[band * size + row.index[i]]);
        }
    }
}

TEST(SelectCoefficients, ZerosAreNeverKeptAndTiesGoByIndex) {
    std::vector<float> dense(formats::cubemap_texels(kSize), 0.0f);
    for (const std::size_t k : {300u, 301u, 302u, 303u}) {
        dense[k] = 1;  // the same support, hence the same score
    }
    const auto row = select_coefficients(make_selector(kSize, 8), dense, 1);
    EXPECT_EQ(row.index, (std::vector<std::uint32_t>{300, 301}));
    EXPECT_TRUE(
        select_coefficients(make_selector(kSize, 8), std::vector<float>(dense.size(), 0.0f), 1)
            .index.empty());
}

}  // namespace
}  // namespace opaline::bake
