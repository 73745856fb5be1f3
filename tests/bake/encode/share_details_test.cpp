#include "bake/encode/share_details.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kEdge = 8;

formats::SparseRow random_row(std::mt19937& engine, float size) {
    std::uniform_real_distribution<float> uniform(-size, size);
    formats::SparseRow row;
    for (std::uint32_t k = 1; k < kEdge * kEdge; ++k) {
        row.index.push_back(k);
        row.value.push_back(uniform(engine));
    }
    row.average.assign(formats::kCubeFaces, size);
    return row;
}

formats::SparseRows rows_of(const std::vector<formats::SparseRow>& each,
                            std::uint32_t code_bits = 16) {
    formats::SparseRows rows = formats::make_sparse_rows(kEdge, code_bits);
    for (const formats::SparseRow& row : each) {
        formats::append_row(rows, row);
    }
    return rows;
}

float size_of(const formats::SparseRows& rows, std::size_t row, std::size_t detail) {
    return rows.detail_scale[row] * static_cast<float>(std::abs(rows.code16[detail]));
}

// The row seen half as well keeps what is twice as large.
TEST(ShareDetails, NoneThatIsLeftOutIsWorthMoreThanOneThatIsKept) {
    std::mt19937 engine(1);
    const formats::SparseRows all =
        rows_of({random_row(engine, 1), random_row(engine, 1), random_row(engine, 0.3f)});
    const std::vector<float> weight{1, 0.5f, 1};
    const formats::SparseRows kept =
        share_details(all, 1, make_selector(kEdge, 0, 0), {{0, 0, 0}, weight, {80}});
    ASSERT_EQ(kept.index16.size(), 80u);
    std::vector<float> scores, of_kept;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t i = all.row_offset[row]; i < all.row_offset[row + 1]; ++i) {
            scores.push_back(weight[row] * size_of(all, row, i));
        }
        for (std::size_t i = kept.row_offset[row]; i < kept.row_offset[row + 1]; ++i) {
            of_kept.push_back(weight[row] * size_of(kept, row, i));
        }
    }
    std::ranges::sort(scores, std::greater<>());
    scores.resize(80);
    std::ranges::sort(of_kept, std::greater<>());
    EXPECT_EQ(of_kept, scores);
    EXPECT_GT(kept.row_offset[1], 2 * (kept.row_offset[3] - kept.row_offset[2]));
    EXPECT_EQ(kept.average_code, all.average_code);
    EXPECT_EQ(kept.average_scale, all.average_scale);
}

// Each pool by itself, of equal details the first ones; where all may stay, all do.
TEST(ShareDetails, PoolsKeepTheirNumbers) {
    std::mt19937 engine(2);
    formats::SparseRow even = random_row(engine, 1);
    std::ranges::fill(even.value, 0.5f);
    const formats::SparseRows all = rows_of({even, even, random_row(engine, 1)}, 8);
    const formats::SparseRows kept =
        share_details(all, 1, make_selector(kEdge, 0, 0), {{0, 0, 1}, {1, 1, 1e-9f}, {70, 1000}});
    EXPECT_EQ(kept.row_offset[1], 63u);
    EXPECT_EQ(kept.row_offset[2], 70u);
    EXPECT_TRUE(std::equal(kept.index16.begin(), kept.index16.begin() + 70, all.index16.begin()));
    EXPECT_GE(kept.row_offset[3], 70 + 62u) << "but for details that have rounded to 0";
    const formats::SparseRows none =
        share_details(all, 1, make_selector(kEdge, 0, 0), {{0, 0, 0}, {1, 1, 1}, {0}});
    EXPECT_TRUE(none.index16.empty());
}

TEST(ShareDetails, ARowThatIsNotANumberStaysSo) {
    std::mt19937 engine(3);
    formats::SparseRow faulty = random_row(engine, 1);
    faulty.value[3] = NAN;
    const formats::SparseRows kept =
        share_details(rows_of({faulty, random_row(engine, 1)}), 1, make_selector(kEdge, 0, 0),
                      {{0, 0}, {1, 1}, {9}});
    EXPECT_EQ(formats::find_faulty_row(kept, 1), 0u);
    EXPECT_EQ(kept.row_offset[2], 9u);
}

}  // namespace
}  // namespace opaline::bake
