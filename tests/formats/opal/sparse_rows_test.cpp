#include "formats/opal/sparse_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "formats/opal/cubemap.h"

namespace opaline::formats {
namespace {

SparseRow random_row(std::uint32_t n, std::uint32_t bands, std::size_t details, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    SparseRow row;
    row.bands = bands;
    for (std::uint32_t k = 1; row.index.size() < details; k += 1 + generator() % 3) {
        if (k % (n * n) != 0) {
            row.index.push_back(k);
        }
    }
    for (std::size_t i = 0; i < bands * details; ++i) {
        row.value.push_back(normal(generator));
    }
    for (std::size_t i = 0; i < bands * std::size_t{6}; ++i) {
        row.average.push_back(10.0f + normal(generator));
    }
    return row;
}

// Half the distance to the next value that a code can stand for.
float half_step(float value, float scale, std::uint32_t bits) {
    return 1.001f * scale * (bits == 8 ? std::sqrt(std::abs(value) / scale) + 0.5f : 0.5f);
}

TEST(SparseRows, DecodedValuesAreTheNearestThatCodesCanStandFor) {
    for (const std::uint32_t n : {8u, 128u}) {
        for (const std::uint32_t bits : {8u, 16u}) {
            for (const std::uint32_t bands : {1u, 3u}) {
                SparseRows rows = make_sparse_rows(n, bits);
                EXPECT_EQ(rows.index_bytes, n == 128 ? 4u : 2u);
                const std::vector<SparseRow> original{random_row(n, bands, 40, 1),
                                                      random_row(n, bands, 25, 2)};
                for (const SparseRow& row : original) {
                    ASSERT_TRUE(append_row(rows, row));
                }
                std::vector<float> dense(cubemap_texels(n));
                for (std::uint32_t r = 0; r < 2; ++r) {
                    for (std::uint32_t band = 0; band < bands; ++band) {
                        decode_row(rows.view(), {0, 2, bands, 0, 0}, r, band, dense);
                        const SparseRow& row = original[r];
                        const float scale = rows.detail_scale[r * bands + band];
                        EXPECT_LT(half_step(3, scale, bits), bits == 8 ? 0.03f : 1e-4f);
                        float kept = 0, all = 0;
                        for (std::size_t i = 0; i < row.index.size(); ++i) {
                            const float value = row.value[band * row.index.size() + i];
                            EXPECT_NEAR(dense[row.index[i]], value, half_step(value, scale, bits));
                            kept += std::abs(dense[row.index[i]]);
                        }
                        for (std::uint32_t k = 0; k < dense.size(); ++k) {
                            if (k % (n * n) == 0) {
                                EXPECT_NEAR(dense[k], row.average[band * 6 + k / (n * n)], 4e-4f);
                            } else {
                                all += std::abs(dense[k]);
                            }
                        }
                        EXPECT_FLOAT_EQ(kept, all);  // nothing stands where nothing was stored
                    }
                }
            }
        }
    }
}

// The middle of two squares is above that of their roots.
TEST(SparseRows, EightBitsTakeTheNearerOfTwoSquares) {
    for (const float beyond : {0.4f, 0.6f}) {
        SparseRow row;
        row.average.assign(6, 0.0f);
        for (std::uint32_t q = 0; q < 127; ++q) {
            row.index.push_back(q + 1);
            row.value.push_back(static_cast<float>(q * q + q) + beyond);
        }
        row.index.push_back(200);
        row.value.push_back(127.0f * 127.0f);  // a scale of one
        SparseRows rows = make_sparse_rows(32, 8);
        ASSERT_TRUE(append_row(rows, row));
        std::vector<float> dense(cubemap_texels(32));
        decode_row(rows.view(), {0, 1, 1, 0, 0}, 0, 0, dense);
        for (std::uint32_t q = 0; q < 127; ++q) {
            const std::uint32_t root = beyond < 0.5f ? q : q + 1;
            ASSERT_EQ(dense[q + 1], static_cast<float>(root * root)) << q;
        }
    }
}

TEST(SparseRows, AppendingBlocksEqualsAppendingRows) {
    SparseRows one_by_one = make_sparse_rows(8, 8), joined = one_by_one;
    for (unsigned block = 0; block < 3; ++block) {
        SparseRows tail = make_sparse_rows(8, 8);
        for (unsigned i = 0; i < 4; ++i) {
            const SparseRow row = random_row(8, 1, 10 + block, 10 * block + i);
            ASSERT_TRUE(append_row(one_by_one, row));
            ASSERT_TRUE(append_row(tail, row));
        }
        ASSERT_TRUE(append_rows(joined, tail));
    }
    EXPECT_EQ(one_by_one.row_offset, joined.row_offset);
    EXPECT_EQ(one_by_one.index16, joined.index16);
    EXPECT_EQ(one_by_one.code8, joined.code8);
    EXPECT_EQ(one_by_one.average_code, joined.average_code);
    EXPECT_EQ(one_by_one.detail_scale, joined.detail_scale);
}

TEST(SparseRows, PickedRowsDecodeAsTheRowsTheyWere) {
    for (const std::uint32_t n : {8u, 128u}) {  // indices of two and of four bytes
        for (const std::uint32_t bits : {8u, 16u}) {
            for (const std::uint32_t bands : {1u, 3u}) {
                SparseRows rows = make_sparse_rows(n, bits);
                for (unsigned i = 0; i < 5; ++i) {
                    ASSERT_TRUE(append_row(rows, random_row(n, bands, 4 + 3 * i, i)));
                }
                const std::vector<std::uint32_t> from{3, 0, 4, 1};
                const SparseRows picked = pick_rows(rows, bands, from);
                ASSERT_EQ(picked.row_offset.size(), from.size() + 1);
                std::vector<float> expected(cubemap_texels(n)), actual(expected.size());
                for (std::uint32_t i = 0; i < from.size(); ++i) {
                    for (std::uint32_t band = 0; band < bands; ++band) {
                        decode_row(rows.view(), {0, 5, bands, 0, 0}, from[i], band, expected);
                        decode_row(picked.view(), {0, 4, bands, 0, 0}, i, band, actual);
                        ASSERT_EQ(actual, expected) << n << ' ' << bits << ' ' << bands;
                    }
                }
            }
        }
    }
}

TEST(SparseRows, WhatIsNotFiniteStaysSoAndIsFound) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    for (const std::uint32_t bits : {8u, 16u}) {
        for (const float bad : {nan, inf, -inf}) {
            for (const bool in_average : {false, true}) {
                SparseRows rows = make_sparse_rows(8, bits);
                SparseRow row = random_row(8, 3, 10, 1);
                ASSERT_TRUE(append_row(rows, row));
                EXPECT_FALSE(find_faulty_row(rows, 3));
                (in_average ? row.average : row.value)[7] = bad;
                ASSERT_TRUE(append_row(rows, row));
                EXPECT_EQ(find_faulty_row(rows, 3), 1u);
                SparseRows all = make_sparse_rows(8, bits);
                ASSERT_TRUE(append_rows(all, rows));
                ASSERT_TRUE(append_rows(all, rows));
                EXPECT_EQ(find_faulty_row(all, 3), 1u);
                const std::uint32_t turned[] = {3, 0, 2, 1};
                EXPECT_EQ(find_faulty_row(pick_rows(all, 3, turned), 3), 0u);
                std::vector<float> dense(cubemap_texels(8));
                decode_row(rows.view(), {0, 2, 3, 0, 0}, 1, in_average ? 1 : 0, dense);
                EXPECT_TRUE(std::isnan(in_average ? dense[64] : dense[row.index[7]]));
            }
        }
    }
}

TEST(SparseRows, ZeroAndDenormalRowsDecodeToZeroNotToNan) {
    SparseRows rows = make_sparse_rows(8, 8);
    ASSERT_TRUE(append_row(rows, {1, {1, 2}, {1e-44f, 0}, {0, 0, 1e-44f, 0, 0, 0}}));
    std::vector<float> dense(cubemap_texels(8));
    decode_row(rows.view(), {0, 1, 1, 0, 0}, 0, 0, dense);
    for (const float value : dense) {
        ASSERT_EQ(value, 0.0f);
    }
}

}  // namespace
}  // namespace opaline::formats
