#include "bake/volumes/scaled_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

formats::PhaseFunction henyey_greenstein(float g) {
    formats::PhaseFunction phase;
    phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    phase.g = g;
    return phase;
}

TEST(ScaledPhase, IsotropicScatteringNeedsOneTermAndHasNoPeak) {
    const ScaledPhase phase = scale_phase({});
    EXPECT_EQ(phase.degree, 0u);
    EXPECT_EQ(phase.harmonics(), 1u);
    EXPECT_EQ(phase.peak, 0);
    EXPECT_FLOAT_EQ(eval_scaled(phase, 0.3f), 1 / (4 * std::numbers::pi_v<float>));
}

TEST(ScaledPhase, RayleighScatteringIsKeptToItsLastDegree) {
    formats::PhaseFunction rayleigh;
    rayleigh.type = formats::PhaseFunction::Type::rayleigh;
    const ScaledPhase phase = scale_phase(rayleigh);
    EXPECT_EQ(phase.degree, 2u);
    for (const float c : {-1.0f, -0.4f, 0.0f, 0.7f, 1.0f}) {
        EXPECT_NEAR(eval_scaled(phase, c), 3 * (1 + c * c) / (16 * std::numbers::pi_v<float>),
                    1e-6);
    }
}

TEST(ScaledPhase, PeakAndRestTogetherHaveTheMomentsOfTheWhole) {
    for (const float g : {0.3f, 0.5f, 0.75f, 0.85f, 0.95f}) {
        const ScaledPhase phase = scale_phase(henyey_greenstein(g));
        for (unsigned l = 0; l <= phase.degree; ++l) {
            EXPECT_NEAR(phase.peak + (1 - phase.peak) * phase.lambda[l],
                        std::pow(static_cast<double>(g), l), 1e-9)
                << g << " degree " << l;
        }
    }
}

TEST(ScaledPhase, ADrawnCosineHasTheMomentsOfTheRest) {
    for (const float g : {-0.6f, 0.0f, 0.5f, 0.9f}) {
        const ScaledPhase phase = scale_phase(henyey_greenstein(g));
        constexpr int kDraws = 20000;
        double sum = 0, first = 0, largest = 0;
        for (int i = 0; i < kDraws; ++i) {
            const SampledCosine s =
                sample_scaled(phase, (static_cast<float>(i) + 0.5f) / static_cast<float>(kDraws));
            ASSERT_LE(std::abs(s.cosine), 1.0f);
            sum += static_cast<double>(s.weight);
            first += static_cast<double>(s.weight) * static_cast<double>(s.cosine);
            largest = std::max(largest, static_cast<double>(std::abs(s.weight)));
        }
        EXPECT_NEAR(sum / kDraws, 1, 2e-3) << g;
        EXPECT_NEAR(first / kDraws, phase.lambda[1], 2e-3) << g;
        EXPECT_LT(largest, 1.7) << g;
    }
}

}  // namespace
}  // namespace opaline::bake
