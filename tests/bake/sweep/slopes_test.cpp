#include "bake/lab/sweep/analysis.h"

#include <gmock/gmock.h>

#include <cmath>

#include "bake/effects/single/single_knobs.h"

namespace opaline::bake {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Slopes, PowerLawIsFoundExactly) {
    std::vector<Convergence> rungs;
    for (const double n : {8.0, 16.0, 32.0, 64.0}) {
        rungs.push_back({n, 3 * std::pow(n, -1.5)});
    }
    const auto fit = fit_slope(rungs, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, -1.5, 1e-12);
    EXPECT_NEAR(std::exp(fit->intercept), 3, 1e-12);
    EXPECT_NEAR(fit->standard_error, 0, 1e-7);
    EXPECT_THAT(fit->saturated, IsEmpty());
}

// Scatter of (+d, -d, -d, +d) around a line through equally spaced abscissae does not turn it, and
// leaves a standard error of sqrt(4 d^2 / 2 / sum (x - mean)^2) = d sqrt(2 / 5) / step.
TEST(Slopes, StandardErrorIsThatOfLeastSquares) {
    const double d = 0.1, step = std::log(2.0);
    std::vector<Convergence> rungs;
    const double sign[] = {1, -1, -1, 1};
    for (int i = 0; i < 4; ++i) {
        rungs.push_back({std::exp(i * step), std::exp(-2 * i * step + sign[i] * d)});
    }
    const auto fit = fit_slope(rungs, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, -2, 1e-12);
    EXPECT_NEAR(fit->standard_error, d * std::sqrt(0.4) / step, 1e-12);
}

TEST(Slopes, RungsOnTheFloorDoNotFlattenTheSlope) {
    const auto fit = fit_slope(
        std::vector<Convergence>{{1, 1.0}, {2, 0.5}, {4, 0.25}, {8, 0.249}, {16, 0.25}}, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, -1, 1e-12);
    EXPECT_THAT(fit->used, ElementsAre(1, 2, 4));
    EXPECT_THAT(fit->saturated, ElementsAre(8, 16));
}

TEST(Slopes, ToleranceThatFallsTakesTheErrorWithIt) {
    const auto fit = fit_slope(
        std::vector<Convergence>{{1e-1, 2e-2}, {1e-2, 2e-3}, {1e-3, 2e-4}, {0, 1e-9}}, false);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 1, 1e-12);
    EXPECT_THAT(fit->used, ElementsAre(1e-1, 1e-2, 1e-3));  // 0 has no logarithm
}

TEST(Slopes, SemiLogarithmicFitFindsTheAnisotropy) {
    std::vector<Convergence> rungs;
    for (int degree = 0; degree < 4; ++degree) {
        rungs.push_back({static_cast<double>(degree), 0.3 * std::pow(0.6, degree + 1)});
    }
    const auto fit = fit_slope(rungs, true);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(std::exp(fit->slope), 0.6, 1e-12);
    EXPECT_NEAR(fit->slope, convergence_theory(ladder_of(kPhaseTerms), 0.6)->rate, 1e-12);
}

TEST(Slopes, NothingIsClaimedOfLessThanTwoPoints) {
    EXPECT_FALSE(fit_slope({}, false));
    EXPECT_FALSE(fit_slope(std::vector<Convergence>{{1, 0.5}}, false));
    EXPECT_FALSE(fit_slope(std::vector<Convergence>{{1, 0.5}, {2, 0.5}}, false));
    EXPECT_FALSE(fit_slope(std::vector<Convergence>{{1, 0.0}, {2, 0.0}}, false));
    EXPECT_EQ(fit_slope(std::vector<Convergence>{{1, 0.5}, {2, 0.25}}, false)->standard_error, 0);
}

TEST(Slopes, SwitchesAndIsotropicPhaseFunctionsHaveNoRate) {
    EXPECT_FALSE(convergence_theory(Ladders::exact_rays, 0.5));
    EXPECT_FALSE(convergence_theory(Ladders::preset, 0.5));
    EXPECT_FALSE(convergence_theory(ladder_of(kPhaseTerms), 0));
}

}  // namespace
}  // namespace opaline::bake
