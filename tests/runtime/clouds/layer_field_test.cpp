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
