#include "formats/media/mean_cosine.h"

#include <gmock/gmock.h>

#include <numbers>

namespace opaline::formats {
namespace {

PhaseFunction gaussian(float rms_angle) {
    PhaseFunction phase;
    phase.type = PhaseFunction::Type::gaussian;
    phase.rms_angle = rms_angle;
    return phase;
}

TEST(MeanCosine, OfHenyeyGreensteinIsItsParameterAndOfSymmetricOnesIsZero) {
    PhaseFunction phase;
    EXPECT_EQ(mean_cosine(phase), 0);
    phase.type = PhaseFunction::Type::rayleigh;
    EXPECT_EQ(mean_cosine(phase), 0);
    phase.type = PhaseFunction::Type::henyey_greenstein;
    phase.g = -0.25f;
    EXPECT_EQ(mean_cosine(phase), -0.25);
}

TEST(MeanCosine, OfANarrowGaussianIsOneLessHalfItsMeanSquareAngle) {
    for (const float rms : {0.02f, 0.05f, 0.1f}) {
        const double square = static_cast<double>(rms) * static_cast<double>(rms);
        // On a flat sky <theta^2> is rms^2 exactly; the next terms are of fourth order, below it.
        EXPECT_NEAR(mean_cosine(gaussian(rms)), 1 - square / 2, square * square) << rms;
    }
}

TEST(MeanCosine, OfALinearTableIsExact) {
    // p = (1 + 3 g mu) / 4 pi has mean cosine g: int mu (3 g mu) dmu / 2 = g.
    PhaseFunction phase;
    phase.type = PhaseFunction::Type::tabulated;
    constexpr double g = 0.25;
    for (const double mu : {-1.0, -0.3, 0.0, 0.9, 1.0}) {
        phase.cosine.push_back(static_cast<float>(mu));
        phase.value.push_back(static_cast<float>((1 + 3 * g * mu) / (4 * std::numbers::pi)));
    }
    EXPECT_NEAR(mean_cosine(phase), g, 1e-7);  // values are single precision
}

}  // namespace
}  // namespace opaline::formats
