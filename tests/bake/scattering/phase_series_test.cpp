#include "bake/physics/phase_series.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/phase.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/bake/scattering/table_support.h"

namespace opaline::bake {
namespace {

using formats::PhaseFunction;
using tests::gaussian;
using tests::hg;
using tests::rayleigh;
using tests::table_of;

using std::numbers::pi;

TEST(PhaseSeries, HenyeyGreensteinErrorsAreThoseOfTheTable) {
    using Row = tests::ReferenceRow;
    const auto series = [](const Row& row) {
        const double degrees = std::ceil(std::sqrt(row.number("K")));
        return expand_henyey_greenstein(row.number("g"), static_cast<unsigned>(degrees));
    };
    const auto terms = [](const Row& row) { return static_cast<unsigned>(row.number("K")); };
    tests::expect_rows("hg_rms_rel",
                       [&](const Row& row) { return phase_rms_relative(series(row), terms(row)); });
    tests::expect_rows("hg_rms_abs",
                       [&](const Row& row) { return phase_rms(series(row), terms(row)); });
}

// Every type against brute force: lambda_l = 2 pi int p P_l over the cosine.
TEST(PhaseSeries, CoefficientsAreTheLegendreMomentsOfTheFunction) {
    constexpr unsigned kDegrees = 9;
    const GaussLegendre rule = make_gauss_legendre(64);
    for (const PhaseFunction& phase :
         {PhaseFunction{}, rayleigh(), hg(0.7), hg(-0.4), gaussian(1), gaussian(0.3),
          table_of({-1, -0.5, 0.2, 0.9, 1}, {0.3f, 0.1f, 0, 0.2f, 2})}) {
        const PhaseDensity density = make_phase_density(phase);
        const PhaseSeries series = expand_phase(phase, kDegrees);
        std::array<double, kDegrees> moment{};
        // Panels that end where the table has its corners.
        constexpr std::array<double, 7> kEnds{-1, -0.5, 0.2, 0.9, 0.97, 0.995, 1};
        for (std::size_t panel = 1; panel < kEnds.size(); ++panel) {
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                const double width = kEnds[panel] - kEnds[panel - 1];
                const double x = kEnds[panel - 1] + width * rule.node[i];
                for (unsigned l = 0; l < kDegrees; ++l) {
                    moment[l] += 2 * pi * width * rule.weight[i] * eval_phase(density, x) *
                                 std::legendre(l, x);
                }
            }
        }
        for (unsigned l = 0; l < kDegrees; ++l) {
            // The table's cosines are in single precision, so its corners are 1e-8 off the panels'
            // ends.
            EXPECT_NEAR(series.lambda[l], moment[l], 1e-7) << int(phase.type) << " degree " << l;
        }
        EXPECT_NEAR(series.lambda[0], 1, 1e-12) << int(phase.type);
    }
}

// For small angles the Gaussian is a normal distribution on the tangent plane with <theta^2> =
// rms^2, whose Fourier transform at frequency l + 1/2 is exp(-(l + 1/2)^2 rms^2 / 4).
TEST(PhaseSeries, NarrowGaussianFallsAsItsFourierTransform) {
    const PhaseSeries series = expand_phase(gaussian(0.01), 200);
    for (const unsigned l : {1u, 10u, 50u, 150u}) {
        const double frequency = l + 0.5;
        EXPECT_NEAR(series.lambda[l], std::exp(-frequency * frequency * 0.25e-4), 1e-4) << l;
    }
    EXPECT_GT(series.tail, 0);
}

TEST(PhaseSeries, ErrorIsThatOfTheReconstruction) {
    const GaussLegendre rule = make_gauss_legendre(200);
    for (const PhaseFunction& phase : {hg(0.6), hg(-0.6), rayleigh(), gaussian(0.7)}) {
        const PhaseDensity density = make_phase_density(phase);
        const PhaseSeries series = expand_phase(phase, 5);
        for (const unsigned degrees : {1u, 2u, 3u, 4u, 5u}) {
            double square = 0, missed = 0;
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                const double x = 2 * rule.node[i] - 1, p = eval_phase(density, x);
                double sum = 0;
                for (unsigned l = 0; l < degrees; ++l) {
                    sum += (2 * l + 1) / (4 * pi) * series.lambda[l] * std::legendre(l, x);
                }
                square += rule.weight[i] * p * p;
                missed += rule.weight[i] * (p - sum) * (p - sum);
            }
            const unsigned terms = degrees * degrees;
            // Differences of squares lose half of the digits.
            EXPECT_NEAR(phase_rms_relative(series, terms), std::sqrt(missed / square), 1e-7);
            EXPECT_NEAR(phase_rms(series, terms), std::sqrt(missed), 1e-7);
        }
    }
}

TEST(PhaseSeries, FewestTermsThatMeetTheToleranceAreWholeDegrees) {
    const auto chosen = [](const PhaseFunction& phase, double tolerance) {
        return choose_phase_terms(expand_phase(phase, 5), tolerance);
    };
    EXPECT_EQ(chosen({}, 0), 1u);
    EXPECT_EQ(chosen(rayleigh(), 0), 9u);
    EXPECT_EQ(chosen(rayleigh(), 0.3), 1u);  // sqrt(.05 / 1.05) = .218
    EXPECT_EQ(chosen(hg(0.25), 0.42), 1u);   // physics/README.md: .4157, .1330, .0392, ...
    EXPECT_EQ(chosen(hg(0.25), 0.41), 4u);
    EXPECT_EQ(chosen(hg(-0.25), 0.04), 9u);
    EXPECT_EQ(chosen(hg(0.25), 0.012), 16u);
    EXPECT_EQ(chosen(hg(0.25), 0.01), 25u);
    EXPECT_EQ(chosen(hg(0.9), 0.01), 25u);  // no K meets the tolerance
}

}  // namespace
}  // namespace opaline::bake
