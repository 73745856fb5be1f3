#include "bake/check/pilot/pilot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace opaline::bake {
namespace {

ErrorBounds around(double rms, double standard_error) {
    return {rms, rms - 2 * standard_error, rms + 2 * standard_error};
}

TEST(ChooseEncoding, TheFirstThatIsSureElseTheFirstHardlyLessSureThanTheSurestIsTaken) {
    struct Row {
        const char* what;
        std::vector<double> errors;
        double deviation, target;
        std::size_t taken;
    };
    for (const Row& row : {
             Row{"1.9 % is likely but not sure", {0.030, 0.019, 0.016, 0.010}, 1e-3, 0.02, 2},
             Row{"all are sure", {0.030, 0.019, 0.016, 0.010}, 1e-3, 0.05, 0},
             Row{"a floor of noise", {0.0150, 0.0096, 0.0091, 0.0090}, 6e-4, 0.01, 2},
             Row{"none is likely", {0.15, 0.103, 0.1}, 1e-3, 0.01, 1},
             Row{"near the surest, but not likely", {0.0098, 0.0094, 0.0094}, 3e-4, 0.01, 1},
         }) {
        std::vector<ErrorBounds> errors;
        for (const double error : row.errors)
            errors.push_back(around(error, row.deviation));
        EXPECT_EQ(choose_encoding(errors, row.target), row.taken) << row.what;
    }
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
