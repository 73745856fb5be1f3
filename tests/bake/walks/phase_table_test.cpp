#include "bake/effects/multiple/walks/ball_bank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/scattering/phase.h"

namespace opaline::bake {
namespace {

using Type = formats::PhaseFunction::Type;

formats::PhaseFunction make(Type type, float g, float rms_angle) {
    formats::PhaseFunction function;
    function.type = type;
    function.g = g;
    function.rms_angle = rms_angle;
    return function;
}

// Mean of the cosine and of its square: by sampling, and by quadrature of the density.
TEST(PhaseTable, SampledCosinesHaveTheMomentsOfTheDensity) {
    std::vector<formats::PhaseFunction> functions{
        make(Type::isotropic, 0, 0), make(Type::rayleigh, 0, 0), make(Type::gaussian, 0, 0.05f),
        make(Type::gaussian, 0, 0.8f)};
    for (const float g : {-0.99f, -0.3f, 1e-5f, 0.5f, 0.99f}) {
        functions.push_back(make(Type::henyey_greenstein, g, 0));
    }
    functions.push_back(make(Type::tabulated, 0, 0));
    functions.back().cosine = {-1, 0, 0.9f, 1};
    functions.back().value = {0.1f, 0, 0.1f, 2};
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
