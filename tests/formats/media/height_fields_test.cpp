#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "formats/media/height_fields.h"
#include "formats/media/lattice.h"

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

// One frame of a sequence.
std::vector<float> frame_of(const std::vector<float>& all, std::size_t texels, std::size_t frame) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(texels * frame);
    return {first, first + static_cast<std::ptrdiff_t>(texels)};
}

TEST(HeightFields, CoverTheSameShareInEveryFrameOfAnEvolution) {
    constexpr std::size_t kTexels = 96 * 96;
    for (const Type type : {Type::cellular, Type::waves}) {
        for (const double coverage : {0.0, 0.4, 1.0}) {
            const auto all =
                make({.type = type, .coverage = coverage, .resolution = 96, .frames = 6});
            ASSERT_EQ(all.size(), 6 * kTexels);
            EXPECT_EQ(*std::max_element(all.begin(), all.end()), coverage > 0 ? 1 : 0);
            for (std::size_t frame = 0; frame < 6; ++frame) {
                EXPECT_NEAR(share_above_zero(frame_of(all, kTexels, frame)), coverage, 0.001);
            }
        }
    }
}

// RMS of the difference between two fields.
double change(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
        sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

// From the last frame to the first one too. Half the step: half the change, and in between frames
// are about the mean of their neighbours.
TEST(HeightFields, EvolveSmoothlyAndPeriodically) {
    constexpr std::size_t kTexels = 64 * 64, kFrames = 32;
    for (const Type type : {Type::cellular, Type::waves}) {
        const auto all = make(
            {.type = type, .scale = 2000, .coverage = 0.9, .resolution = 64, .frames = kFrames});
        double mean = 0, twice = 0, largest = 0, bend = 0;
        for (std::size_t i = 0; i < kFrames; ++i) {
            const auto now = frame_of(all, kTexels, i);
            const auto next = frame_of(all, kTexels, (i + 1) % kFrames);
            const auto later = frame_of(all, kTexels, (i + 2) % kFrames);
            std::vector<float> blend;
            for (std::size_t k = 0; k < kTexels; ++k) {
                blend.push_back((now[k] + later[k]) / 2);
            }
            mean += change(now, next) / kFrames;
            twice += change(now, later) / kFrames;
            largest = std::max(largest, change(now, next));
            bend += change(blend, next) / kFrames;
        }
        EXPECT_GT(mean, 0.005);
        EXPECT_LT(largest, 1.5 * mean);
        EXPECT_NEAR(twice / mean, 2, 0.15);
        EXPECT_LT(bend, 0.3 * mean);
        // Half a period later it is another layer.
        EXPECT_GT(change(frame_of(all, kTexels, 0), frame_of(all, kTexels, kFrames / 2)), 5 * mean);
    }
}

// The waves' part of a field: modes whose direction and length are about theirs.
std::vector<std::complex<double>> wave_modes(const std::vector<float>& field, std::size_t side) {
    std::vector<std::complex<double>> root, modes;
    for (std::size_t i = 0; i < side; ++i) {
        root.push_back(std::polar(
            1.0, -2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(side)));
    }
    for (std::size_t kx = 5; kx <= 11; ++kx) {
        for (std::size_t ky = side - 3; ky <= side + 7; ++ky) {
            std::complex<double> sum;
            for (std::size_t k = 0; k < field.size(); ++k) {
                sum += static_cast<double>(field[k]) *
                       root[(kx * (k % side) + ky * (k / side)) % side];
            }
            modes.push_back(sum);
        }
    }
    return modes;
}

// cos(phase - turn): all modes turn back alike, wherever crests bend.
TEST(HeightFields, CrestsTravelByAWavelengthInAPeriod) {
    constexpr std::size_t kSide = 48, kFrames = 8;
    const auto all =
        make({.type = Type::waves, .scale = 1000, .resolution = kSide, .frames = kFrames});
    std::vector<std::complex<double>> before;
    for (std::size_t i = 0; i <= kFrames; ++i) {
        const auto now = wave_modes(frame_of(all, kSide * kSide, i % kFrames), kSide);
        if (i > 0) {
            std::complex<double> sum;
            for (std::size_t k = 0; k < now.size(); ++k) {
                sum += now[k] * std::conj(before[k]);
            }
            EXPECT_NEAR(std::arg(sum), -2 * std::numbers::pi / kFrames, 0.25) << i;
        }
        before = now;
    }
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

const Lattice kLattice{5, 3, 100};

TEST(Lattice, OctavesAddUpWithTheirWeights) {
    const auto octaves = make_octaves(kLattice, 2, 7);
    const double first = eval_noise(make_noise(kLattice, 7), {1.3, 0.6});
    const double second = eval_noise(make_noise(finer(kLattice, 2), 8), {2.6, 1.2});
    EXPECT_NEAR(eval_octaves(octaves, 0.4, {1.3, 0.6}), first + 0.4 * second, 1e-12);
}

TEST(Lattice, DomesStayInTheirSquaresAndRepeat) {
    Lattice lattice{9, 8, 100, true, 0};
    for (int step = 0; step < 8; ++step) {
        lattice.turn = step * std::numbers::pi / 4;
        const Domes domes = make_domes(lattice, 3);
        for (const Domes::Dome& dome : domes.dome) {
            EXPECT_LE(std::max(std::abs(dome.x), std::abs(dome.y)), 0.425);
            EXPECT_NEAR(dome.height, 1, 0.2501);
        }
        double largest = 0;
        for (int i = 0; i < 500; ++i) {
            const LatticePoint p{0.137 * i, 0.0713 * i};
            const double height = eval_domes(domes, p);
            largest = std::max(largest, height);
            EXPECT_NEAR(eval_domes(domes, {p.x - 9, p.y + 16}), height, 1e-9);
            // No dome appears at once where others enter the neighbourhood.
            EXPECT_NEAR(eval_domes(domes, {p.x + 1e-6, p.y}), height, 1e-4);
        }
        EXPECT_GT(largest, 0.8);
        EXPECT_LT(largest, 1.3 * 1.25);
    }
}

TEST(Lattice, WhatTexelsCannotShowIsLeftOut) {
    const Lattice fine = finer({5, 3, 20}, 7);
    EXPECT_TRUE(fine.is_too_fine());
    EXPECT_TRUE(make_noise(fine, 1).slope.empty() && make_domes(fine, 1).dome.empty());
    EXPECT_EQ(eval_noise(make_noise(fine, 1), {3.2, 1.1}), 0);
    EXPECT_EQ(eval_domes(make_domes(fine, 1), {3.2, 1.1}), 0);
}

}  // namespace

}  // namespace opaline::formats
