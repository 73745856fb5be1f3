#include "formats/media/height_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace opaline::formats {
namespace {

using Type = HeightFieldShape::Type;

std::vector<float> make(HeightFieldShape shape, std::array<double, 2> size = {8000, 8000}) {
    return make_height_field(shape, size);
}

double share_above_zero(const std::vector<float>& field) {
    const auto above = std::count_if(field.begin(), field.end(), [](float h) { return h > 0; });
    return static_cast<double>(above) / static_cast<double>(field.size());
}

// Mean absolute difference between the columns `a` and `b`, or rows.
double step(const std::vector<float>& field, std::size_t side, std::size_t a, std::size_t b,
            bool is_row) {
    double sum = 0;
    for (std::size_t i = 0; i < side; ++i) {
        const std::size_t p = is_row ? a * side + i : i * side + a;
        const std::size_t q = is_row ? b * side + i : i * side + b;
        sum += std::abs(static_cast<double>(field[p]) - static_cast<double>(field[q]));
    }
    return sum / static_cast<double>(side);
}

TEST(HeightFields, CoverTheStatedShareOfTheArea) {
    for (const Type type : {Type::cellular, Type::waves}) {
        for (const double coverage : {0.0, 0.05, 0.3, 0.7, 0.95, 1.0}) {
            for (const double scale : {500.0, 8000.0, 1e7}) {
                const auto field =
                    make({.type = type, .scale = scale, .coverage = coverage, .resolution = 128});
                EXPECT_NEAR(share_above_zero(field), coverage, 0.001) << scale;
            }
        }
    }
}

TEST(HeightFields, AreBetween0And1AndReachBoth) {
    for (const Type type : {Type::cellular, Type::waves}) {
        for (const std::uint32_t side : {16u, 17u, 200u}) {
            const auto field =
                make({.type = type, .scale = 2000, .coverage = 0.8, .resolution = side});
            ASSERT_EQ(field.size(), std::size_t{side} * side);
            EXPECT_EQ(*std::min_element(field.begin(), field.end()), 0);
            EXPECT_EQ(*std::max_element(field.begin(), field.end()), 1);
        }
    }
}

// Across the seam neighbours differ no more than elsewhere.
TEST(HeightFields, RepeatWithoutASeam) {
    constexpr std::size_t kSide = 160;
    for (const Type type : {Type::cellular, Type::waves}) {
        for (const double scale : {400.0, 900.0, 3000.0, 8000.0}) {
            const auto field = make({.type = type, .scale = scale, .resolution = kSide});
            for (const bool is_row : {false, true}) {
                double largest = 0;
                for (std::size_t i = 0; i + 1 < kSide; ++i) {
                    largest = std::max(largest, step(field, kSide, i, i + 1, is_row));
                }
                EXPECT_LE(step(field, kSide, kSide - 1, 0, is_row), largest) << scale << is_row;
            }
        }
    }
}

TEST(HeightFields, AreTheSameOnEveryRunAndOthersWithAnotherSeed) {
    for (const Type type : {Type::cellular, Type::waves}) {
        const HeightFieldShape shape{.type = type, .resolution = 64};
        HeightFieldShape other = shape;
        other.seed = 2;
        EXPECT_EQ(make(shape), make(shape));
        EXPECT_NE(make(shape), make(other));
    }
}

// The share of a field's variance that a wave of (kx, ky) periods carries.
double power(const std::vector<float>& field, std::size_t side, int kx, int ky) {
    std::complex<double> sum = 0;
    double variance = 0, mean = 0;
    for (const float h : field) {
        mean += static_cast<double>(h);
    }
    mean /= static_cast<double>(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
        const double phase =
            2 * std::numbers::pi / static_cast<double>(side) *
            (kx * static_cast<double>(i % side) + ky * static_cast<double>(i / side));
        const double h = static_cast<double>(field[i]) - mean;
        sum += h * std::polar(1.0, phase);
        variance += h * h;
    }
    return 2 * std::norm(sum) / (variance * static_cast<double>(field.size()));
}

TEST(HeightFields, WavesHaveOneDirectionAndCellsHaveNone) {
    constexpr std::size_t kSide = 96;
    const auto anisotropy = [](Type type) {
        // Second moments of the power along both axes, up to twice the frequency of the scale.
        const auto field = make({.type = type, .scale = 1000, .resolution = kSide});
        double x = 0, y = 0;
        for (int kx = 0; kx <= 16; ++kx) {
            for (int ky = kx == 0 ? 1 : -16; ky <= 16; ++ky) {
                const double p = power(field, kSide, kx, ky);
                x += p * kx * kx;
                y += p * ky * ky;
            }
        }
        return x / y;
    };
    EXPECT_GT(anisotropy(Type::waves), 2);
    EXPECT_NEAR(anisotropy(Type::cellular), 1, 0.35);
}

TEST(HeightFields, CellsAndWavesAreAsLargeInMetresAlongBothSides) {
    // Twice as long along z: twice as many cells there. Steps per metre are about equal.
    constexpr std::size_t kSide = 128;
    const auto field =
        make({.type = Type::cellular, .scale = 1000, .resolution = kSide}, {8000, 16000});
    double x = 0, z = 0;
    for (std::size_t i = 0; i + 2 < kSide; ++i) {
        x += step(field, kSide, i, i + 2, false);  // 125 m
        z += step(field, kSide, i, i + 1, true);   // 125 m
    }
    EXPECT_NEAR(x / z, 1, 0.15);
}

}  // namespace
}  // namespace opaline::formats
