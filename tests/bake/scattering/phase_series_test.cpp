#include "bake/scattering/phase_series.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "bake/scattering/gauss_legendre.h"
#include "bake/scattering/phase.h"
#include "formats/opal/spherical_harmonics.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

using formats::PhaseFunction;
using tests::gaussian;
using tests::hg;
using tests::rayleigh;
using tests::table_of;

using std::numbers::pi;

TEST(PhaseSeries, HenyeyGreensteinErrorsAreThoseOfTheTable) {
    OPALINE_REFERENCE_ROWS(relative, "translucency.csv", "hg_rms_rel");
    OPALINE_REFERENCE_ROWS(absolute, "translucency.csv", "hg_rms_abs");
    const auto series = [](const tests::ReferenceRow& row) {
        const double degrees = std::ceil(std::sqrt(row.number("K")));
        return expand_henyey_greenstein(row.number("g"), static_cast<unsigned>(degrees));
    };
    for (const auto& row : relative) {
        EXPECT_NEAR(phase_rms_relative(series(row), static_cast<unsigned>(row.number("K"))),
                    row.expected, row.tolerance())
            << row.name();
    }
    for (const auto& row : absolute) {
        EXPECT_NEAR(phase_rms(series(row), static_cast<unsigned>(row.number("K"))), row.expected,
                    row.tolerance())
            << row.name();
    }
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

TEST(PhaseSeries, HenyeyGreensteinAndRayleighAreExact) {
    const PhaseSeries forward = expand_phase(hg(-0.5), 6);
    for (int l = 0; l < 6; ++l) {
        EXPECT_EQ(forward.lambda[std::size_t(l)], std::pow(-0.5, l));
    }
    EXPECT_EQ(expand_phase(rayleigh(), 5).lambda, (std::vector<double>{1, 0, 0.1, 0, 0}));
    EXPECT_EQ(expand_phase({}, 3).lambda, (std::vector<double>{1, 0, 0}));
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
    EXPECT_EQ(chosen(hg(0.25), 0.42), 1u);   // scattering/README.md: .4157, .1330, .0392, ...
    EXPECT_EQ(chosen(hg(0.25), 0.41), 4u);
    EXPECT_EQ(chosen(hg(-0.25), 0.04), 9u);
    EXPECT_EQ(chosen(hg(0.25), 0.012), 16u);
    EXPECT_EQ(chosen(hg(0.25), 0.01), 25u);
    EXPECT_EQ(chosen(hg(0.9), 0.01), 25u);  // no K meets the tolerance
}

// w_i toward the light and w_o toward the eye point away from the scattering point: unscattered
// light has w_o = -w_i, and g > 0 makes that the brightest direction.
TEST(PhaseSeries, HarmonicsOfForwardScatteringAreBrightestOppositeTheLight) {
    const formats::Vec3 w_i{0.48f, -0.6f, 0.64f};
    for (const double g : {0.5, -0.5}) {
        const std::vector<double> weight = harmonic_weights(expand_phase(hg(g), 5), 25);
        const PhaseSeries series = expand_phase(hg(g), 5);
        std::array<float, 25> y_i{}, y_o{};
        formats::eval_spherical_harmonics(w_i, y_i);
        const auto value = [&](formats::Vec3 w_o) {
            formats::eval_spherical_harmonics(w_o, y_o);
            double sum = 0;
            for (std::size_t k = 0; k < 25; ++k) {
                sum += weight[k] * double(y_i[k]) * double(y_o[k]);
            }
            return sum;
        };
        const double ahead = value({-w_i.x, -w_i.y, -w_i.z}), back = value(w_i);
        EXPECT_EQ(ahead > back, g > 0);
        // The addition theorem turns the sum over orders into Legendre polynomials.
        const formats::Vec3 w_o{0.6f, 0.8f, 0};
        const double x = -double(formats::dot(w_i, w_o));
        double expected = 0;
        for (unsigned l = 0; l < 5; ++l) {
            expected += (2 * l + 1) / (4 * pi) * series.lambda[l] * std::legendre(l, x);
        }
        EXPECT_NEAR(value(w_o), expected, 1e-6);  // harmonics are in single precision
    }
}

// 4 terms of Henyey-Greenstein are (1 + 3 g cos) / (4 pi), below 0 for |g| > 1/3.
TEST(PhaseSeries, TruncatedFunctionMayBeNegative) {
    const std::vector<double> weight = harmonic_weights(expand_phase(hg(0.4), 2), 4);
    const formats::Vec3 w{0, 0, 1};
    std::array<float, 4> y{};
    formats::eval_spherical_harmonics(w, y);
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        sum += weight[k] * double(y[k]) * double(y[k]);
    }
    EXPECT_NEAR(sum, -0.2 / (4 * pi), 1e-7);
}

}  // namespace
}  // namespace opaline::bake
