#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/physics/mie/angular_table.h"
#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/phase.h"
#include "tests/bake/mie/mie_support.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

using tests::kDegree;

AngularTable fine_henyey(double g) {
    AngularTable table;
    for (int i = 0; i <= 3600; ++i) {
        table.angle.push_back(i * 0.05 * kDegree);
        table.value.push_back(henyey_greenstein(std::cos(table.angle.back()), g));
    }
    table.angle.back() = pi;
    scale_table(table, 1 / integrate_table(table));
    return table;
}

TEST(ForwardPeak, PartsAddUpToThePhaseFunction) {
    const AngularTable phase = fine_henyey(0.85);
    for (const double angle : {0.02 * kDegree, 5 * kDegree, 33.33 * kDegree, 90 * kDegree}) {
        const PeakSplit split = split_peak(phase, angle);
        EXPECT_NEAR(integrate_table(split.peak), 1, 1e-12);
        EXPECT_NEAR(integrate_table(split.rest), 1, 1e-12);
        EXPECT_NEAR(split.weight, integrate_within(phase, angle), 1e-12);
        for (const double at : {0.0, 0.4 * angle, 1.3 * angle, 2.0, pi}) {
            const double sum = split.weight * eval_table(split.peak, at) +
                               (1 - split.weight) * eval_table(split.rest, at);
            EXPECT_NEAR(sum / eval_table(phase, at), 1, 1e-12) << at;
        }
        // g_S = (g - P_f g_F) / (1 - P_f)
        const double rest =
            (integrate_cosine(phase) - split.weight * integrate_cosine(split.peak)) /
            (1 - split.weight);
        EXPECT_NEAR(integrate_cosine(split.rest), rest, 1e-12);
        EXPECT_NEAR(rest_extinction(split, 0.04), 0.04 * (1 - split.weight), 1e-15);
    }
}

TEST(ForwardPeak, WithoutAnAngleThereIsNoPeak) {
    const AngularTable phase = fine_henyey(0.5);
    const PeakSplit split = split_peak(phase, 0);
    EXPECT_EQ(split.weight, 0);
    EXPECT_EQ(split.rest.value, phase.value);
    EXPECT_EQ(rest_extinction(split, 2), 2);
    EXPECT_EQ(forward_glow(split, {}, 3, 0.1), 0);
}

// Henyey-Greenstein: -d(log p)/d(angle) = 3 g sin t / (1 + g^2 - 2 g cos t).
TEST(ForwardPeak, EndsWhereTheSlopeHasFallenBelowTheRule) {
    for (const double g : {0.995, 0.99, 0.98}) {
        const double angle = find_peak_angle(fine_henyey(g));
        ASSERT_GT(angle, 0) << g;
        const double slope =
            3 * g * std::sin(angle) / (1 + g * g - 2 * g * std::cos(angle)) * kDegree;
        EXPECT_NEAR(slope, 0.44, 0.01) << g;
    }
    EXPECT_EQ(find_peak_angle(fine_henyey(0.5)), 0);
    EXPECT_EQ(find_peak_angle(fine_henyey(0)), 0);
}

TEST(ForwardPeak, GlowHoldsAllLightThatWasScatteredInThePeak) {
    const AngularTable phase = fine_henyey(0.95);
    const PeakSplit split = split_peak(phase, 20 * kDegree);
    const std::vector<double> moments = table_moments(split.peak, 600);
    for (const double events : {1e-9, 0.3, 1.0, 4.0, 30.0, 1e4}) {
        double sum = 0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = pi * (i + 0.5) / kSteps;
            const double glow = forward_glow(split, moments, events, angle);
            ASSERT_TRUE(std::isfinite(glow)) << events;
            sum += 2 * pi * std::sin(angle) * pi / kSteps * glow;
        }
        EXPECT_NEAR(sum / -std::expm1(-events), 1, 1e-3) << events;
    }
    // One scattering: the table itself, with its edge.
    EXPECT_NEAR(forward_glow(split, moments, 1e-9, 0.1) / 1e-9, eval_table(split.peak, 0.1), 1e-6);
    EXPECT_NEAR(forward_glow(split, moments, 1e-9, 0.5) / 1e-9, 0, 1e-6);
    EXPECT_EQ(forward_glow(split, moments, 0, 0.1), 0);
}

// g^l squared is the moment of a function of mean cosine g^2.
TEST(ForwardPeak, TwoScatteringsOfHenyeyAndGreensteinHaveTheSquareOfTheMeanCosine) {
    const AngularTable phase = fine_henyey(0.8);
    const SelfConvolution twice = convolve_with_itself(phase, 300, phase.angle);
    EXPECT_NEAR(integrate_table(twice.table), 1, 1e-12);
    EXPECT_NEAR(twice.integral, 1, 1e-5);
    for (const double angle : {0.0, 0.5, 1.5, pi}) {
        EXPECT_NEAR(eval_table(twice.table, angle) / henyey_greenstein(std::cos(angle), 0.64), 1,
                    1e-3)
            << angle;
    }
}

// The edge at theta_f makes a series of few moments ring below 0; what is returned never is.
TEST(ForwardPeak, TwoScatteringsAreNeverNegative) {
    // A ring of 3 degrees: twice scattered light is dark in between.
    AngularTable ring{{60 * kDegree, 60.1 * kDegree, 63 * kDegree}, {1, 1, 1}};
    scale_table(ring, 1 / integrate_table(ring));
    std::vector<double> angles;
    for (int i = 0; i <= 720; ++i) {
        angles.push_back(i == 720 ? pi : i * 0.25 * kDegree);
    }
    const SelfConvolution few = convolve_with_itself(ring, 12, angles);
    EXPECT_LT(few.lowest, 0);
    for (const double value : few.table.value) {
        EXPECT_GE(value, 0);
    }
    EXPECT_NEAR(integrate_table(few.table), 1, 1e-12);
    EXPECT_GT(few.integral, 1);
    const SelfConvolution many = convolve_with_itself(ring, kConvolutionMoments, angles);
    EXPECT_GT(many.lowest, 1e-3 * few.lowest);
    // Light cannot turn by more than twice the ring's angle.
    EXPECT_LT(eval_table(many.table, 135 * kDegree), 1e-4);
}

AngularTable henyey_table(double g, double step) {
    AngularTable table;
    const int last = static_cast<int>(std::lround(180 / step));
    for (int i = 0; i <= last; ++i) {
        table.angle.push_back(i == last ? pi : i * step * kDegree);
        table.value.push_back(henyey_greenstein(std::cos(table.angle.back()), g));
    }
    return table;
}

TEST(AngularTable, IntegralsAreThoseOfHenyeyAndGreenstein) {
    const AngularTable table = henyey_table(0.7, 0.1);
    EXPECT_NEAR(integrate_table(table), 1, 1e-5);  // linear between rows
    EXPECT_NEAR(integrate_cosine(table), 0.7, 1e-5);
    // int_mu^1 2 pi p = (1 - g^2) / (2 g) (1 / (1 - g) - 1 / sqrt(1 + g^2 - 2 g mu))
    for (const double angle : {0.5, 5.0, 40.0, 123.4, 180.0}) {
        const double mu = std::cos(angle * kDegree), g = 0.7;
        const double within =
            (1 - g * g) / (2 * g) * (1 / (1 - g) - 1 / std::sqrt(1 + g * g - 2 * g * mu));
        EXPECT_NEAR(integrate_within(table, angle * kDegree), within, 1e-5) << angle;
    }
    EXPECT_EQ(integrate_within(table, 0), 0);
}

// A table of two rows is linear in the cosine over the whole sphere.
TEST(AngularTable, LinearFunctionIsExactWithTwoRows) {
    const AngularTable table{{0, pi}, {2 / (4 * pi), 0}};
    EXPECT_NEAR(integrate_table(table), 1, 1e-15);
    EXPECT_NEAR(integrate_cosine(table), 1.0 / 3, 1e-15);
    EXPECT_NEAR(eval_table(table, pi / 2), 1 / (4 * pi), 1e-16);
    const std::vector<double> moments = table_moments(table, 60);
    EXPECT_NEAR(moments[0], 1, 1e-12);
    EXPECT_NEAR(moments[1], 1.0 / 3, 1e-12);
    for (std::size_t l = 2; l < moments.size(); ++l) {
        EXPECT_NEAR(moments[l], 0, 1e-9) << l;
    }
}

TEST(AngularTable, MomentsArePowersOfGAndGiveTheFunctionBack) {
    const AngularTable table = henyey_table(0.6, 0.05);
    const std::vector<double> moments = table_moments(table, 100);
    for (std::size_t l = 0; l < 30; ++l) {
        EXPECT_NEAR(moments[l], std::pow(0.6, l), 2e-6) << l;
    }
    const std::vector<double> angles{0, 0.3, 1.0, 2.0, pi};
    const std::vector<double> values = sum_moments(moments, angles);
    for (std::size_t i = 0; i < angles.size(); ++i) {
        EXPECT_NEAR(values[i] / henyey_greenstein(std::cos(angles[i]), 0.6), 1, 1e-3);
    }
}

TEST(AngularTable, ThinTableErrsByNoMoreThanItsTolerance) {
    const AngularTable table = henyey_table(0.9, 0.02);
    const AngularTable thin = thin_table(table, 0.002);
    EXPECT_LT(thin.angle.size(), table.angle.size() / 20);
    EXPECT_EQ(thin.angle.front(), 0);
    EXPECT_EQ(thin.angle.back(), pi);
    for (std::size_t i = 0; i < table.angle.size(); ++i) {
        EXPECT_NEAR(eval_table(thin, table.angle[i]) / table.value[i], 1, 0.002001)
            << table.angle[i];
    }
    EXPECT_EQ(thin_table(table, 0).angle.size(), table.angle.size());
}

// cos(a) - cos(b) of small angles has no digits left in the difference of rounded cosines.
TEST(AngularTable, CosinesOfSmallAnglesKeepTheirDigits) {
    EXPECT_NEAR(cosine_difference(0, 1e-9) / 5e-19, 1, 1e-12);
    EXPECT_NEAR(cosine_difference(1e-6, 2e-6) / 1.5e-12, 1, 1e-9);
    EXPECT_NEAR(cosine_difference(0, pi), 2, 1e-15);
}

}  // namespace

}  // namespace opaline::bake
