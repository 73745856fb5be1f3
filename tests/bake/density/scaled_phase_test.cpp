#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/effects/volumes/degree_rate.h"
#include "bake/trace/density/scaled_phase.h"
#include "tests/bake/scattering/phase_support.h"

namespace opaline::bake {
namespace {

TEST(ScaledPhase, IsotropicScatteringNeedsOneTermAndHasNoPeak) {
    const ScaledPhase phase = scale_phase({});
    EXPECT_EQ(phase.degree, 0u);
    EXPECT_EQ(phase.harmonics(), 1u);
    EXPECT_EQ(phase.peak, 0);
    EXPECT_FLOAT_EQ(eval_scaled(phase, 0.3f), 1 / (4 * std::numbers::pi_v<float>));
}

TEST(ScaledPhase, RayleighScatteringIsKeptToItsLastDegree) {
    const ScaledPhase phase = scale_phase(tests::rayleigh());
    EXPECT_EQ(phase.degree, 2u);
    for (const float c : {-1.0f, -0.4f, 0.0f, 0.7f, 1.0f}) {
        EXPECT_NEAR(eval_scaled(phase, c), 3 * (1 + c * c) / (16 * std::numbers::pi_v<float>),
                    1e-6);
    }
}

TEST(ScaledPhase, PeakAndRestTogetherHaveTheMomentsOfTheWhole) {
    for (const float g : {0.3f, 0.5f, 0.75f, 0.85f, 0.95f}) {
        const ScaledPhase phase = scale_phase(tests::hg(g));
        for (unsigned l = 0; l <= phase.degree; ++l) {
            EXPECT_NEAR(phase.peak + (1 - phase.peak) * phase.lambda[l],
                        std::pow(static_cast<double>(g), l), 1e-9)
                << g << " degree " << l;
        }
    }
}

// Weights multiply from turn to turn: a mean size of 1.04, that of p' of g = 0.9, is 10 after 60.
TEST(ScaledPhase, NoWalkWeighsMoreByTurningAndDrawnCosinesHaveTheMeanOfTheRest) {
    std::vector<formats::PhaseFunction> phases{tests::gaussian(0.11f), tests::gaussian(0.3f)};
    for (const double g : {-0.9, -0.6, 0.0, 0.5, 0.85, 0.9, 0.95}) {
        phases.push_back(tests::hg(g));
    }
    for (const formats::PhaseFunction& function : phases) {
        const ScaledPhase phase = scale_phase(function);
        constexpr int kDraws = 20000;
        double size = 0, cosine = 0, largest = 0;
        for (int i = 0; i < kDraws; ++i) {
            const SampledCosine drawn =
                sample_scaled(phase, (static_cast<float>(i) + 0.5f) / static_cast<float>(kDraws));
            const double weight = static_cast<double>(drawn.weight);
            ASSERT_GE(weight, 0) << phase.lambda[1];
            ASSERT_LE(std::abs(drawn.cosine), 1.0f);
            size += weight / kDraws;
            cosine += weight * static_cast<double>(drawn.cosine) / kDraws;
            largest = std::max(largest, weight);
        }
        EXPECT_NEAR(size, 1, 2e-3) << phase.lambda[1];
        EXPECT_NEAR(cosine, phase.lambda[1], 2e-3);
        EXPECT_LT(largest, 1.7) << phase.lambda[1];
    }
}

// Over the sphere, of p' without its part in the harmonics up to `degree`; by quadrature, without
// the moments.
double square_beyond(const ScaledPhase& phase, unsigned degree) {
    constexpr int kSteps = 20000;
    std::vector<double> rest(kSteps);
    const auto cosine = [](int i) { return -1 + (i + 0.5) * 2 / kSteps; };
    for (int i = 0; i < kSteps; ++i) {
        rest[static_cast<std::size_t>(i)] = eval_scaled(phase, static_cast<float>(cosine(i)));
    }
    double square = 0;
    for (unsigned l = 0; l <= degree; ++l) {
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            sum += rest[static_cast<std::size_t>(i)] * std::legendre(l, cosine(i)) * 2 / kSteps;
        }
        for (int i = 0; i < kSteps; ++i) {
            rest[static_cast<std::size_t>(i)] -=
                (2 * l + 1) / 2.0 * sum * std::legendre(l, cosine(i));
        }
    }
    for (const double each : rest) {
        square += each * each;
    }
    return square;
}

TEST(RateOfDegree, IsThatOfWhatRowsLackOfThePhaseFunction) {
    for (const float g : {-0.6f, 0.3f, 0.5f, 0.85f}) {
        const ScaledPhase phase = scale_phase(tests::hg(g));
        const double all = square_beyond(phase, 0), last = square_beyond(phase, phase.degree - 1);
        EXPECT_NEAR(rate_of_degree(g), std::log(last / all) / 2 / (phase.degree - 1), 2e-3) << g;
    }
}

TEST(RateOfDegree, ErrorsMeasuredOfACloudFallAtLeastAsFast) {
    // RMS of light scattered more than once, K = 1 and 16 against 25 (tests/bench/RESULTS.md).
    EXPECT_LE(std::log(0.015 / 0.37) / 3, rate_of_degree(0.5));
    EXPECT_LE(std::log(0.051 / 0.69) / 3, rate_of_degree(0.85));
    EXPECT_LT(rate_of_degree(0.85), -0.4);
}

TEST(RateOfDegree, ScatteringWithoutDegreesHasNone) {
    EXPECT_EQ(rate_of_degree(0), 0);
    EXPECT_EQ(rate_of_degree(0.004), 0);
}

double moment_of(const TurnRule& rule, unsigned degree) {
    double sum = 0, before = 0;
    for (std::size_t i = 0; i < rule.count; ++i) {
        const auto below = static_cast<double>(rule.below[i]);
        sum += (below - before) * std::legendre(degree, static_cast<double>(rule.cosine[i]));
        before = below;
    }
    return sum;
}

TEST(TurnRule, LightOfLowDegreesIsScatteredAsByTheFunction) {
    for (const double g : {0.85, 0.9, 0.95}) {
        const ScaledPhase phase = scale_phase(tests::hg(g));
        ASSERT_EQ(phase.rule.count, 3u) << g;
        for (unsigned l = 0; l <= phase.degree; ++l) {
            EXPECT_NEAR(moment_of(phase.rule, l), phase.lambda[l], 1e-5) << g << " degree " << l;
        }
        EXPECT_NEAR(moment_of(phase.rule, 5), 0, 1e-5) << g << ": the peak took it";
    }
}

// Without its peak a narrow Gaussian has the mean cosine .930 and a second moment of .793; no
// chances have that: of .930 it is (3 .930^2 - 1) / 2 = .797 at least.
TEST(TurnRule, MomentsThatNoChancesHaveLeaveTheLowerOnes) {
    const ScaledPhase phase = scale_phase(tests::gaussian(0.11f));
    const double mean = phase.lambda[1];
    ASSERT_LT(phase.lambda[2], (3 * mean * mean - 1) / 2);
    ASSERT_EQ(phase.rule.count, 1u);
    EXPECT_NEAR(moment_of(phase.rule, 1), mean, 1e-6);
}

TEST(TurnRule, ScatteringThatIsNowhereNegativeNeedsNone) {
    EXPECT_EQ(scale_phase(tests::hg(0.5)).rule.count, 0u);
    EXPECT_EQ(scale_phase(tests::rayleigh()).rule.count, 0u);
}

}  // namespace

}  // namespace opaline::bake
