#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/phase.h"
#include "bake/physics/phase_series.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/bake/scattering/table_support.h"
#include "tests/support/volume_table.h"

namespace opaline::bake {
namespace {

TEST(HenyeyGreenstein, ValuesAreThoseOfTheTable) {
    tests::expect_rows("hg", [](const tests::ReferenceRow& row) {
        return henyey_greenstein(row.number("cos"), row.number("g"));
    });
}

// Over theta = pi x^4, which spreads the forward peak.
TEST(HenyeyGreenstein, MeanSquareAngleIsThatOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "hg_mean_square_angle");
    const GaussLegendre rule = make_gauss_legendre(600);
    for (const auto& row : rows) {
        double mean = 0;
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double x = rule.node[i], theta = std::numbers::pi * x * x * x * x;
            mean += rule.weight[i] * 4 * std::numbers::pi * x * x * x * 2 * std::numbers::pi *
                    std::sin(theta) * theta * theta *
                    henyey_greenstein(std::cos(theta), row.number("g"));
        }
        EXPECT_NEAR(mean, row.value(), 1e-9) << row.id();
    }
}

TEST(HenyeyGreenstein, PeakIsExactForExtremeAsymmetry) {
    for (const double g : {0.99, 0.9999}) {
        EXPECT_NEAR(henyey_greenstein(1, g) * 4 * std::numbers::pi * (1 - g) * (1 - g) / (1 + g), 1,
                    1e-10);
    }
}

// Density [1/sr] over directions of light that was scattered at least once: the first order is that
// of `density`, exactly.
double eval_after_many(const PhaseDensity& density, const PhaseSeries& series, double ell,
                       double cosine) {
    if (!(ell > 0)) return eval_phase(density, cosine);
    // Of those scattered at all, the share that is scattered once: its series converges slowest.
    const double once = ell * std::exp(-ell) / -std::expm1(-ell);
    std::vector<double> rest;
    rest.reserve(series.lambda.size());
    for (const double lambda : series.lambda) {
        rest.push_back(moment_after_many(lambda, ell) - once * lambda);
    }
    return once * eval_phase(density, cosine) + eval_zonal(rest, cosine);
}

TEST(PoissonPhase, ShareThatIsScatteredIsThatOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "w_ms");
    for (const auto& row : rows) {
        const double share = scattered_share(row.number("sigma_t"), row.number("arg"));
        EXPECT_NEAR(share, row.value(), 1e-11 * row.value() + 1e-12 * 1e-12) << row.id();
    }
}

TEST(PoissonPhase, ShareGrowsWithDepthAndStaysBetween0And1) {
    double last = 0;
    for (double ell = 1e-12; ell < 1e9; ell *= 1.7) {
        const double share = scattered_share(0, ell);
        EXPECT_GE(share, last);
        EXPECT_LE(share, 1);
        last = share;
    }
    EXPECT_EQ(scattered_share(0, 0), 0);
}

TEST(PoissonPhase, MeanCosinesAreThoseOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "gs_mean_cos");
    for (const auto& row : rows) {
        const double mean = moment_after_many(row.number("g"), row.number("arg"));
        EXPECT_NEAR(mean, row.value(), 1e-10 * std::abs(row.value())) << row.id();
    }
}

// The table's g are decimal fractions, a medium's are floats: orders beyond the first come from the
// series alone.
TEST(PoissonPhase, DensitiesAreThoseOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "gs_value_at_lx");
    const PhaseDensity other = make_phase_density(tests::hg(0.5));
    for (const auto& row : rows) {
        const double g = row.number("g"), ell = row.number("arg"), cosine = row.number("lx");
        if (g < 0) continue;
        const double once = ell * std::exp(-ell) / -std::expm1(-ell);
        const double value =
            eval_after_many(other, expand_henyey_greenstein(g, 1024), ell, cosine) +
            once * (henyey_greenstein(cosine, g) - eval_phase(other, cosine));
        EXPECT_NEAR(value, row.value(), 1e-10 * row.value()) << row.id();
    }
}

// The table's rows of g = -0.3 are the series cut after eight degrees, and wrong in the fourth
// digit.
TEST(PoissonPhase, OfBackwardScatteringTheTableHasEightDegrees) {
    OPALINE_VOLUME_ROWS(rows, "gs_value_at_lx");
    int count = 0;
    for (const auto& row : rows) {
        const double g = row.number("g"), ell = row.number("arg"), cosine = row.number("lx");
        if (g >= 0) continue;
        const auto sum = [&](unsigned degrees) {
            std::vector<double> moments;
            for (const double lambda : expand_henyey_greenstein(g, degrees).lambda) {
                moments.push_back(moment_after_many(lambda, ell));
            }
            return eval_zonal(moments, cosine);
        };
        EXPECT_NEAR(sum(8), row.value(), 1e-10) << row.id();
        EXPECT_GT(std::abs(sum(64) - row.value()), 1e-7) << row.id();
        EXPECT_NEAR(sum(64), sum(1024), 1e-14) << row.id();
        const PhaseDensity phase = make_phase_density(tests::hg(g));
        EXPECT_NEAR(eval_after_many(phase, expand_henyey_greenstein(g, 64), ell, cosine), sum(64),
                    1e-7)
            << row.id();
        ++count;
    }
    EXPECT_EQ(count, 3);
}

// A ray is a free flight before it scatters for the first time (math: Duhamel's integral).
TEST(PoissonPhase, MomentsOfARayAreThoseOfSourcesAlongIt) {
    const GaussLegendre rule = make_gauss_legendre(64);
    for (const double lambda : {-0.9, -0.3, 0.2, 0.75, 0.99}) {
        for (const double ell : {1e-9, 0.1, 3.0, 20.0}) {
            double sum = 0;
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                const double t = ell * rule.node[i];
                sum += ell * rule.weight[i] * std::exp(-t) * moment_of_source(lambda, ell - t);
            }
            EXPECT_NEAR(moment_of_ray(lambda, ell), sum, 1e-12 * std::abs(sum) + 1e-18)
                << lambda << ' ' << ell;
        }
    }
}

TEST(PoissonPhase, IsFiniteForEveryDepth) {
    for (const double lambda : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        for (const double ell : {0.0, 1e-300, 1e-10, 1.0, 88.0, 710.0, 1e9}) {
            for (const double moment : {moment_after_many(lambda, ell), moment_of_ray(lambda, ell),
                                        moment_of_source(lambda, ell)}) {
                EXPECT_TRUE(std::isfinite(moment)) << lambda << ' ' << ell;
                EXPECT_LE(std::abs(moment), 1) << lambda << ' ' << ell;
            }
        }
    }
}

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
