#include "bake/encode/select_coefficients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <random>

#include "bake/plan/knobs.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "formats/opal/sparse_rows.h"

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

// Also if the coefficient would not be kept.
TEST(SelectCoefficients, OneThatIsNotFiniteSpoilsItsRow) {
    for (const std::uint32_t bands : {1u, 3u}) {
        for (const float bad :
             {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            std::vector<float> dense = random_coefficients(bands);
            formats::SparseRows rows = formats::make_sparse_rows(kSize, 8);
            ASSERT_TRUE(formats::append_row(
                rows, select_coefficients(make_selector(kSize, 8), dense, bands)));
            dense[dense.size() - 5] = bad;
            ASSERT_TRUE(formats::append_row(
                rows, select_coefficients(make_selector(kSize, 8), dense, bands)));
            EXPECT_EQ(formats::find_faulty_row(rows, bands), 1u);
        }
    }
}

TEST(SelectCoefficients, TheErrorNamesTheStageAndTheReceiver) {
    constexpr std::uint32_t kTerms = 4, kBands = 3;
    formats::SparseRows rows = formats::make_sparse_rows(kSize, 8);
    std::vector<float> dense = random_coefficients(kBands);
    for (std::uint32_t row = 0; row < 5 * kTerms; ++row) {
        dense[70] = row == 14 ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
        if (row == 14) {
            EXPECT_TRUE(require_finite(rows, kTerms, kBands, "rows of 'Vase'"));
        }
        ASSERT_TRUE(formats::append_row(
            rows, select_coefficients(make_selector(kSize, 30), dense, kBands)));
    }
    const auto status = require_finite(rows, kTerms, kBands, "rows of 'Vase'");
    ASSERT_FALSE(status);
    const formats::Diagnostic& said = status.error().diagnostics.at(0);
    EXPECT_EQ(said.where, "rows of 'Vase'");
    EXPECT_EQ(said.fault, "the light transport of vertex 3 is not a finite number");
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

// Irradiance transport of a surface before which a wall hides a part of the sky.
std::vector<float> half_hidden_cosine(std::uint32_t n) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 1, 0.2f));
    const glm::vec3 wall = glm::normalize(glm::vec3(1, 0.4f, -0.6f));
    std::vector<float> row(formats::cubemap_texels(n));
    for (std::uint32_t j = 0; j < row.size(); ++j) {
        const formats::Vec3 d = formats::texel_direction(n, j / (n * n), j / n % n, j % n);
        const glm::vec3 w(d.x, d.y, d.z);
        row[j] = glm::dot(wall, w) > 0.3f ? 0.0f : std::max(0.0f, glm::dot(normal, w));
    }
    formats::haar_forward_cube(std::span<float>(row), n);
    return row;
}

// Square of what is lost: the mean over lights that have equal energy in every coefficient.
double lost_energy(const std::vector<float>& dense, const formats::SparseRow& row, std::uint32_t n,
                   std::uint32_t code_bits) {
    formats::SparseRows rows = formats::make_sparse_rows(n, code_bits);
    formats::append_row(rows, row);
    std::vector<float> stored(dense.size());
    formats::decode_row(rows.view(), {0, 1, 1, 0, 0}, 0, 0, stored);
    double lost = 0;
    for (std::size_t k = 0; k < dense.size(); ++k) {
        lost += std::pow(double{stored[k]} - double{dense[k]}, 2);
    }
    return lost;
}

TEST(SelectCoefficients, EightBitsLoseHardlyMoreThanSixteenBesideWhatIsLeftOut) {
    constexpr std::uint32_t n = 32;
    const std::vector<float> dense = half_hidden_cosine(n);
    const double whole = energy(dense);
    for (const std::uint32_t kept : {64u, 256u, 512u}) {
        const auto row = select_coefficients(make_selector(n, kept), dense, 1);
        const double eight = lost_energy(dense, row, n, 8),
                     sixteen = lost_energy(dense, row, n, 16);
        EXPECT_GT(sixteen, 1e-7 * whole) << kept;
        EXPECT_LT(eight, 1.1 * sixteen) << kept;
    }
    // With all coefficients, square-root codes lose much less than equal steps would.
    const auto all = select_coefficients(make_selector(n, kAllCoefficients), dense, 1);
    float largest = 0;
    for (const float value : all.value) {
        largest = std::max(largest, std::abs(value));
    }
    double equal_steps = 0;
    for (const float value : all.value) {
        const float step = largest / 127;
        equal_steps += std::pow(step * std::round(value / step) - value, 2);
    }
    EXPECT_LT(lost_energy(dense, all, n, 8), 0.2 * equal_steps);
}

}  // namespace
}  // namespace opaline::bake
