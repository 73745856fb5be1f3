#include "bake/encode/share_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "bake/plan/knobs.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSharedSide = 8, kSharedTerms = 2, kMeanKept = 40;

// Rows of receivers of which each is half as bright as the one before.
std::vector<std::vector<float>> dimming_rows(std::size_t receivers) {
    std::mt19937 generator(4);
    std::normal_distribution<float> normal;
    std::vector<std::vector<float>> rows(receivers);
    float size = 1;
    for (std::vector<float>& row : rows) {
        for (std::size_t k = 0; k < kSharedTerms * formats::cubemap_texels(kSharedSide); ++k) {
            row.push_back(size * normal(generator) * normal(generator));
        }
        size /= 2;
    }
    return rows;
}

formats::SparseRows encode_wide(const RowEncoder& encoder, std::vector<std::vector<float>>& dense,
                                LossMeter& meter) {
    const RowEncoder wide = widen(encoder);
    formats::SparseRows rows = empty_rows(wide);
    for (std::vector<float>& values : dense) {
        const DenseRow row{values, kSharedSide, kSharedTerms, 1};
        encode_receiver(wide, row, rows);
        meter.add(row);
    }
    return rows;
}

// As many details as before; a receiver of a quarter of the light keeps fewer, not a quarter.
TEST(ShareRows, DarkReceiversKeepFewerDetailsOfTheSameNumber) {
    std::vector<std::vector<float>> dense = dimming_rows(3);
    const RowEncoder encoder = make_row_encoder(kSharedSide, kMeanKept, 16);
    LossMeter meter(widen(encoder), {kSharedTerms, 1});
    const formats::SparseRows rows =
        share_rows(encode_wide(encoder, dense, meter), {kSharedTerms, 1}, encoder);
    EXPECT_EQ(rows.index16.size(), 3 * kSharedTerms * (kMeanKept - 6));
    const std::uint32_t bright = rows.row_offset[kSharedTerms],
                        dark =
                            rows.row_offset[3 * kSharedTerms] - rows.row_offset[2 * kSharedTerms];
    EXPECT_LT(dark, bright);
    EXPECT_GT(dark, bright / 4);
    EXPECT_LE(bright, kSharedTerms * (2 * kMeanKept - 6));
}

// What is lost in two steps is what the rows lack of the dense ones.
TEST(ShareRows, LossesAddUp) {
    for (const TermsSeen seen : {TermsSeen::apart, TermsSeen::together}) {
        std::vector<std::vector<float>> dense = dimming_rows(3);
        const RowEncoder encoder = make_row_encoder(kSharedSide, kMeanKept, 8);
        LossMeter meter(widen(encoder), {kSharedTerms, 1, seen});
        formats::SparseRows wide = encode_wide(encoder, dense, meter);
        const formats::SparseRows rows =
            share_rows(std::move(wide), {kSharedTerms, 1, seen}, encoder);
        const std::vector<RowLoss> losses = meter.losses(rows);
        for (std::size_t i = 0; i < dense.size(); ++i) {
            const float direct =
                receiver_loss({dense[i], kSharedSide, kSharedTerms, 1}, seen, rows, i).error();
            const float tolerance = seen == TermsSeen::apart ? 1e-3f : 0.03f;
            EXPECT_NEAR(losses[i].error(), direct, tolerance * direct);
        }
    }
}

TEST(ShareRows, RowsOfAllCoefficientsStay) {
    std::vector<std::vector<float>> dense = dimming_rows(2);
    const RowEncoder encoder = make_row_encoder(kSharedSide, kAllCoefficients, 8);
    LossMeter meter(widen(encoder), {kSharedTerms, 1});
    const formats::SparseRows before = encode_wide(encoder, dense, meter);
    const formats::SparseRows after = share_rows(before, {kSharedTerms, 1}, encoder);
    EXPECT_EQ(after.index16, before.index16);
    EXPECT_EQ(after.code8, before.code8);
}

}  // namespace
}  // namespace opaline::bake
