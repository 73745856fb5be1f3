#include "runtime/clouds/layer_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace opaline::runtime {
namespace {

formats::LayerRecord field_record(std::uint32_t columns, std::uint32_t rows, bool repeats) {
    formats::LayerRecord record;
    record.size = {1000, 600};
    record.center = {200, -100};
    record.highest = 300;
    record.columns = columns;
    record.rows = rows;
    record.flags = repeats ? formats::LayerRecord::kRepeat : 0;
    return record;
}

std::vector<std::uint16_t> uneven_codes(std::size_t count) {
    std::vector<std::uint16_t> codes(count);
    for (std::size_t i = 0; i < count; ++i) {
        codes[i] = static_cast<std::uint16_t>((i * 7919 + i * i * 31) % 65536);
    }
    return codes;
}

TEST(LayerField, EveryLevelHasTheSameMeanForAnySize) {
    for (const auto& [columns, rows] : {std::pair(8u, 4u), {13u, 7u}, {3u, 1u}, {1u, 5u}}) {
        const LayerField field = make_layer_field(field_record(columns, rows, true),
                                                  uneven_codes(std::size_t{columns} * rows), 0);
        double first = 0;
        for (const MipLevel<float>& level : field.thickness.level) {
            const double mean = std::accumulate(level.value.begin(), level.value.end(), 0.0) /
                                static_cast<double>(level.value.size());
            if (first == 0) first = mean;
            EXPECT_NEAR(mean / first, 1, 1e-6) << columns << " " << level.columns;
        }
        EXPECT_EQ(field.thickness.level.back().value.size(), 1u);
    }
}

TEST(LayerField, HoldsTheCodesAtTheCentresOfItsCells) {
    const auto codes = uneven_codes(12);
    const LayerField field = make_layer_field(field_record(4, 3, false), codes, 0);
    for (std::uint32_t row = 0; row < 3; ++row) {
        for (std::uint32_t column = 0; column < 4; ++column) {
            const double x = 200 - 500 + 250 * (column + 0.5), z = -100 - 300 + 200 * (row + 0.5);
            EXPECT_NEAR(sample_thickness(field, x, z, 0), 300.0f * codes[row * 4 + column] / 65535,
                        1e-3);
        }
    }
}

TEST(LayerField, FallsToNothingOutsideUnlessItRepeats) {
    const std::vector<std::uint16_t> full(16, 65535);
    const LayerField single = make_layer_field(field_record(4, 4, false), full, 0);
    EXPECT_FLOAT_EQ(sample_thickness(single, -300, -100, 0), 150);  // the edge is half way
    EXPECT_EQ(sample_thickness(single, -300 - 126, -100, 0), 0);
    EXPECT_EQ(sample_thickness(single, 1e9, -100, 3), 0);
    const auto codes = uneven_codes(16);
    const LayerField endless = make_layer_field(field_record(4, 4, true), codes, 0);
    for (const double x : {-250.0, 3.0, 444.0}) {
        EXPECT_NEAR(sample_thickness(endless, x, 17, 0.5f),
                    sample_thickness(endless, x + 5000, 17 - 1800, 0.5f), 1e-2);
    }
}

TEST(LayerField, MovesWithTheWind) {
    formats::LayerRecord record = field_record(8, 8, true);
    record.wind = {3, -2};
    const auto codes = uneven_codes(64);
    const LayerField before = make_layer_field(record, codes, 0);
    const LayerField after = make_layer_field(record, codes, 100);
    const LayerField late = make_layer_field(record, codes, 100 + 1e9);
    EXPECT_NEAR(sample_thickness(after, 10 + 300, 20 - 200, 0), sample_thickness(before, 10, 20, 0),
                1e-2);
    // 3e9 m are 3e6 periods, -2e9 m are no whole number of 600 m.
    EXPECT_NEAR(sample_thickness(late, 10 + 300, 20 - 200 - std::fmod(2e9, 600), 0),
                sample_thickness(before, 10, 20, 0), 1e-2);
    record.flags = 0;
    EXPECT_TRUE(std::isfinite(sample_thickness(make_layer_field(record, codes, 1e308), 10, 20, 0)));
}

formats::LayerRecord three_frames(bool loops) {
    formats::LayerRecord record = field_record(5, 3, true);
    record.frames = 3;
    record.frame_seconds = 20;
    record.flags |= loops ? formats::LayerRecord::kLoop : 0;
    return record;
}

TEST(LayerField, ThicknessIsLinearInTimeBetweenFrames) {
    const auto codes = uneven_codes(3 * 15);
    for (const bool loops : {false, true}) {
        const formats::LayerRecord record = three_frames(loops);
        const auto single = [&](std::size_t frame) {
            return make_layer_field(field_record(5, 3, true),
                                    std::span(codes).subspan(15 * frame, 15), 0);
        };
        const auto expect_blend = [&](double time, std::size_t first, std::size_t second,
                                      float share) {
            const LayerField field = make_layer_field(record, codes, time);
            const LayerField a = single(first), b = single(second);
            ASSERT_EQ(field.thickness.level.size(), a.thickness.level.size());
            for (std::size_t level = 0; level < a.thickness.level.size(); ++level) {
                for (std::size_t i = 0; i < a.thickness.level[level].value.size(); ++i) {
                    EXPECT_NEAR(field.thickness.level[level].value[i],
                                (1 - share) * a.thickness.level[level].value[i] +
                                    share * b.thickness.level[level].value[i],
                                1e-3)
                        << time << " " << loops;
                }
            }
        };
        expect_blend(0, 0, 1, 0);
        expect_blend(15, 0, 1, 0.75f);
        expect_blend(20, 1, 2, 0);
        expect_blend(39, 1, 2, 0.95f);
        expect_blend(40, 2, 2, 0);
        expect_blend(50, 2, loops ? 0 : 2, 0.5f);
        expect_blend(75, loops ? 0 : 2, loops ? 1 : 2, 0.75f);
        expect_blend(-5, loops ? 2 : 0, 0, 0.75f);
    }
}

TEST(LayerField, FramesOfAnyTimeAreThoseThatThereAre) {
    for (const bool loops : {false, true}) {
        for (const float seconds : {1e-3f, 20.0f, 1e9f}) {
            formats::LayerRecord record = three_frames(loops);
            record.frame_seconds = seconds;
            for (const double time : {0.0, -1e-300, -1e-9, 60.0, 1e9, -1e9, 1e308, -1e308, HUGE_VAL,
                                      -HUGE_VAL, std::nan("")}) {
                const FrameBlend blend = blend_frames(record, time);
                EXPECT_LT(blend.first, 3u);
                EXPECT_LT(blend.second, 3u);
                EXPECT_TRUE(blend.share >= 0 && blend.share <= 1) << time;
            }
            EXPECT_EQ(blend_frames(record, std::nan("")), FrameBlend{});
        }
    }
    EXPECT_EQ(blend_frames(field_record(5, 3, true), 17), FrameBlend{});
}

TEST(LayerField, SlopeIsThatOfAPlane) {
    std::vector<std::uint16_t> codes;
    for (std::uint32_t row = 0; row < 16; ++row) {
        for (std::uint32_t column = 0; column < 16; ++column) {
            codes.push_back(static_cast<std::uint16_t>(1000 * column + 2000 * row));
        }
    }
    const LayerField field = make_layer_field(field_record(16, 16, false), codes, 0);
    const LayerSlope slope = sample_slope(field, 200, -100, 0);
    EXPECT_NEAR(slope.x, 300.0 * 1000 / 65535 / (1000.0 / 16), 1e-4);
    EXPECT_NEAR(slope.z, 300.0 * 2000 / 65535 / (600.0 / 16), 1e-4);
}

TEST(LayerField, LevelsAreContinuous) {
    const LayerField field = make_layer_field(field_record(16, 16, true), uneven_codes(256), 0);
    for (const float level : {1.0f, 2.0f, 3.0f}) {
        EXPECT_NEAR(sample_thickness(field, 33, 44, level - 1e-4f),
                    sample_thickness(field, 33, 44, level + 1e-4f), 0.05);
    }
}

}  // namespace
}  // namespace opaline::runtime
