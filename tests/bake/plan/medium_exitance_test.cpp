#include "bake/plan/medium_exitance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/fresnel.h"

namespace opaline::bake {
namespace {

// A row that all views share leaves with pi c_exit.
TEST(MediumExitance, EvenRadianceLeavesThroughTheBoundary) {
    RowLayout layout;
    layout.translucent = layout.constant = layout.separate = true;
    for (const float eta : {1.0f, 1.3f, 1.5f}) {
        const std::vector<float> weight = weigh_rows_of_medium(layout, eta, {0, 0, 1});
        ASSERT_EQ(weight.size(), 1u);
        double exit = 0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
            const double c = (i + 0.5) / kSteps;
            exit += 2 * c * fresnel_transmittance(c, eta) / kSteps;
        }
        EXPECT_NEAR(weight[0] / (std::numbers::pi * exit), 1, 0.01) << eta;
    }
}

// Without a boundary w' = w, and the mean of a harmonic over diffuse views is known: of
// Y_1 = sqrt(3 / 4 pi) c it is 2/3 of its value along the normal.
TEST(MediumExitance, HarmonicsAreAveragedOverViews) {
    RowLayout layout;
    layout.translucent = true;
    layout.harmonics = 4;
    const std::vector<float> weight = weigh_rows_of_medium(layout, 1, {0, 0, 1});
    ASSERT_EQ(weight.size(), 4u);
    const double pi = std::numbers::pi;
    EXPECT_NEAR(weight[0], pi * std::sqrt(0.25 / pi), 1e-3);
    double first = 0;
    for (std::size_t k = 1; k < 4; ++k) {
        first += static_cast<double>(weight[k]) * weight[k];
    }
    EXPECT_NEAR(std::sqrt(first), pi * std::sqrt(0.75 / pi) * 2 / 3, 0.02);
}

}  // namespace
}  // namespace opaline::bake
