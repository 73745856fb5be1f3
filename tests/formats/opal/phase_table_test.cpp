#include "formats/opal/phase_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <vector>

namespace opaline::formats {
namespace {

template <class Phase>
std::vector<float> make_table(Phase phase) {
    std::vector<float> table;
    for (std::size_t i = 0; i < kPhaseEntries; ++i) {
        table.push_back(static_cast<float>(phase(phase_cosine(static_cast<double>(i)))));
    }
    return table;
}

TEST(PhaseTable, PlacesOfCosinesAreInverseAndSteady) {
    EXPECT_EQ(phase_coordinate(-1), 0);
    EXPECT_EQ(phase_coordinate(0), 128);
    EXPECT_EQ(phase_coordinate(1), 256);
    for (float at = 0.25f; at < 256; at += 0.25f) {
        const auto cosine = static_cast<float>(phase_cosine(static_cast<double>(at)));
        // A cosine near 1 or -1 has the rounding of floats there, 6e-8.
        EXPECT_NEAR(phase_coordinate(cosine), at, 4e-4f);
        EXPECT_LT(phase_cosine(static_cast<double>(at - 0.25f)), static_cast<double>(cosine));
    }
}

TEST(PhaseTable, StepsAreFineInAngleEverywhere) {
    for (std::size_t i = 0; i + 1 < kPhaseEntries; ++i) {
        const double from = std::acos(phase_cosine(static_cast<double>(i)));
        const double to = std::acos(phase_cosine(static_cast<double>(i + 1)));
        EXPECT_LT(from - to, 0.9 * std::numbers::pi / 180);
        EXPECT_GT(from - to, 0.6 * std::numbers::pi / 180);
    }
}

TEST(PhaseTable, IsLinearBetweenEntriesAndHasNoPlaceOutside) {
    const std::vector<float> table = make_table([](double c) { return 2 + c * c * c; });
    for (std::size_t i = 0; i + 1 < kPhaseEntries; ++i) {
        const auto middle = static_cast<float>(phase_cosine(static_cast<double>(i) + 0.5));
        EXPECT_NEAR(eval_phase_table(table, middle), 0.5f * (table[i] + table[i + 1]), 1e-5f);
    }
    EXPECT_EQ(eval_phase_table(table, -1), table.front());
    EXPECT_EQ(eval_phase_table(table, 1), table.back());
    EXPECT_EQ(eval_phase_table(table, 1.0001f), table.back());
    EXPECT_EQ(eval_phase_table(table, std::numeric_limits<float>::infinity()), table.back());
    EXPECT_EQ(eval_phase_table(table, std::numeric_limits<float>::quiet_NaN()), table.front());
}

// The integral of c^m over the sphere is 4 pi / (m + 1), 0 for odd m.
TEST(PhaseTable, IntegralsOverTheSphere) {
    EXPECT_NEAR(integrate_phase_table(make_table([](double) { return 1; })), 4 * std::numbers::pi,
                1e-5);
    EXPECT_NEAR(integrate_phase_table(make_table([](double c) { return 1 + c; })),
                4 * std::numbers::pi, 1e-5);
    // Linear pieces lie above a parabola.
    EXPECT_NEAR(integrate_phase_table(make_table([](double c) { return 3 * c * c; })),
                4 * std::numbers::pi, 5e-4);
}

// A midpoint sum over the table as it is evaluated finds the same.
TEST(PhaseTable, IntegralIsThatOfTheValuesBetweenEntriesToo) {
    std::vector<float> table(kPhaseEntries, 0.0f);
    table[3] = table[100] = table[128] = table[255] = table[256] = 1;
    constexpr int kSteps = 1 << 20;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = (i + 0.5) * std::numbers::pi / kSteps;
        sum += std::sin(angle) *
               static_cast<double>(eval_phase_table(table, static_cast<float>(std::cos(angle))));
    }
    sum *= 2 * std::numbers::pi * std::numbers::pi / kSteps;
    EXPECT_NEAR(integrate_phase_table(table) / sum, 1, 1e-5);
}

}  // namespace
}  // namespace opaline::formats
