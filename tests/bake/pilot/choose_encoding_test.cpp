#include "bake/accuracy/pilot/pilot.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace opaline::bake {
namespace {

ErrorBounds around(double rms, double standard_error) {
    return {rms, rms - 2 * standard_error, rms + 2 * standard_error};
}

TEST(ChooseEncoding, TheFirstThatIsSureToMeetTheTargetIsTaken) {
    const std::array errors{around(0.030, 1e-3), around(0.019, 1e-3), around(0.016, 1e-3),
                            around(0.010, 1e-3)};
    EXPECT_EQ(choose_encoding(errors, 0.02), 2u) << "1.9 % is likely but not sure";
    EXPECT_EQ(choose_encoding(errors, 0.05), 0u);
}

TEST(ChooseEncoding, WhereNoneIsSureTheFirstThatIsHardlyLessSureThanTheSurestIsTaken) {
    // A floor of .9 %, whose noise no coefficient lowers.
    const std::array errors{around(0.0150, 6e-4), around(0.0096, 6e-4), around(0.0091, 6e-4),
                            around(0.0090, 6e-4)};
    EXPECT_EQ(choose_encoding(errors, 0.01), 2u);
}

TEST(ChooseEncoding, WhereNoneIsLikelyBytesAreNotWasted) {
    const std::array errors{around(0.15, 1e-3), around(0.103, 1e-3), around(0.1, 1e-3)};
    EXPECT_EQ(choose_encoding(errors, 0.01), 1u);
}

TEST(ChooseEncoding, WhatIsLikelyIsTakenBeforeWhatIsHardlyLessSure) {
    // Within a twentieth of the surest, but not even likely.
    const std::array errors{around(0.0098, 3e-4), around(0.0094, 3e-4), around(0.0094, 3e-4)};
    EXPECT_GT(likely_error(errors[0]), 0.01);
    EXPECT_EQ(choose_encoding(errors, 0.01), 1u);
}

TEST(ChooseEncoding, ACheckWithNoiseOfItsOwnFindsMoreThanIsSureInOneOfFortyCases) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 1e-3);
    int above = 0;
    constexpr int kCases = 20000;
    for (int i = 0; i < kCases; ++i) {
        const double pilot = 0.02 + noise(random), check = 0.02 + noise(random);
        above += check > sure_error(around(pilot, 1e-3)) ? 1 : 0;
    }
    // 1 - Phi(2) = 2.275 %, to five standard errors of this count.
    const double expected = 0.5 * std::erfc(std::numbers::sqrt2);
    EXPECT_NEAR(above / double{kCases}, expected, 5 * std::sqrt(expected / kCases));
}

}  // namespace
}  // namespace opaline::bake
