
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bake/physics/phase_series.h"
#include "bake/physics/phase.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/support/volume_table.h"

namespace opaline::bake {
namespace {

// The table's g are decimal fractions, a medium's are floats.
TEST(PowerPhase, MeanCosinesAreThoseOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "power_mean_cos");
    for (const auto& row : rows) {
        const double g = row.number("g");
        const double slack = 3e-7 / (1 - std::abs(g));
        EXPECT_NEAR(power_moments(tests::hg(g), row.number("arg"), 2)[1] / row.value(), 1, slack)
            << row.id();
    }
}

TEST(PowerPhase, DensitiesAreThoseOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "power_value_at_lx");
    for (const auto& row : rows) {
        const double g = row.number("g");
        const double value =
            eval_zonal(power_moments(tests::hg(g), row.number("arg"), 1024), row.number("lx"));
        EXPECT_NEAR(value / row.value(), 1, 3e-6 / (1 - std::abs(g))) << row.id();
    }
}

TEST(PowerPhase, OneScatteringIsThePhaseFunctionItself) {
    for (const auto& phase : {tests::hg(0.8), tests::hg(-0.3), tests::rayleigh(),
                              tests::gaussian(0.11f), tests::gaussian(1.5f)}) {
        const std::vector<double> moment = power_moments(phase, 0, 40);
        const PhaseSeries series = expand_phase(phase, 40);
        for (std::size_t l = 0; l < moment.size(); ++l) {
            EXPECT_NEAR(moment[l], series.lambda[l], 1e-9) << l;
        }
    }
}

// Powers of exp(-angle^2 / w^2) are of its kind: w grows by 1 / sqrt(s).
TEST(PowerPhase, PowersOfAGaussianAreWiderGaussians) {
    for (const double ell : {0.5, 4.0, 60.0, 900.0}) {
        const double s = -std::expm1(-ell) / ell;
        const float width = 0.11f / static_cast<float>(std::sqrt(s));
        const std::vector<double> moment = power_moments(tests::gaussian(0.11f), ell, 20);
        const PhaseSeries wide = expand_phase(tests::gaussian(width), 20);
        for (std::size_t l = 0; l < moment.size(); ++l) {
            EXPECT_NEAR(moment[l], wide.lambda[l], 1e-6) << ell << ' ' << l;
        }
    }
}

TEST(PowerPhase, BeyondItsDepthThePowerIsEvenInAllDirections) {
    for (const auto& phase : {tests::hg(0.9), tests::gaussian(0.11f), tests::rayleigh(),
                              tests::table_of({-1, 0, 0.9f, 1}, {1, 0, 1, 5})}) {
        const std::vector<double> moment = power_moments(phase, depth_of_even_power(phase), 3);
        EXPECT_EQ(moment[0], 1);
        EXPECT_LT(std::abs(moment[1]), 0.01);
        EXPECT_LT(std::abs(moment[2]), 0.01);
    }
}

}  // namespace
}  // namespace opaline::bake
