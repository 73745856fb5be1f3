#include "bake/effects/multiple/walks/ball_bank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/phase.h"
#include "tests/bake/scattering/phase_support.h"

namespace opaline::bake {
namespace {

// Mean of the cosine and of its square: by sampling, and by quadrature of the density.
TEST(PhaseTable, SampledCosinesHaveTheMomentsOfTheDensity) {
    std::vector<formats::PhaseFunction> functions{
        {},
        tests::rayleigh(),
        tests::gaussian(0.05f),
        tests::gaussian(0.8f),
        tests::table_of({-1, 0, 0.9f, 1}, {0.1f, 0, 0.1f, 2})};
    for (const double g : {-0.99, -0.3, 1e-5, 0.5, 0.99}) {
        functions.push_back(tests::hg(g));
    }
    for (const formats::PhaseFunction& function : functions) {
        const PhaseTable table = make_phase_table(function);
        const PhaseDensity density = make_phase_density(function);
        constexpr int kSamples = 200000, kSteps = 400000;
        double first = 0, second = 0, all = 0, mean = 0, square = 0;
        for (int i = 0; i < kSamples; ++i) {
            const auto c = static_cast<double>(
                sample_cosine(table, (static_cast<float>(i) + 0.5f) / kSamples));
            ASSERT_LE(std::abs(c), 1);
            first += c / kSamples;
            second += c * c / kSamples;
        }
        for (int i = 0; i < kSteps; ++i) {
            const double angle = std::numbers::pi * (i + 0.5) / kSteps;
            const double weight = std::sin(angle) * eval_phase(density, std::cos(angle));
            all += weight;
            mean += weight * std::cos(angle);
            square += weight * std::cos(angle) * std::cos(angle);
        }
        EXPECT_NEAR(first, mean / all, 2e-4) << static_cast<int>(function.type) << function.g;
        EXPECT_NEAR(second, square / all, 2e-4) << static_cast<int>(function.type) << function.g;
    }
}

}  // namespace
}  // namespace opaline::bake
