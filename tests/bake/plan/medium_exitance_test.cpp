#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/fresnel.h"
#include "bake/physics/phase_series.h"
#include "bake/physics/slab/even_light.h"
#include "bake/plan/medium_exitance.h"
#include "tests/support/media.h"

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

formats::Medium forward_medium(float albedo, float g) {
    formats::Medium medium = tests::make_grey_medium(albedo, 1 - albedo);
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = g;
    return medium;
}

// The rest is the dipole's, whose own reflectance errs by a tenth.
TEST(ScatteredOnce, ShareIsThatOfAHalfSpace) {
    for (const float eta : {1.0f, 1.3f, 1.5f}) {
        for (const float albedo : {0.3f, 0.8f, 0.95f}) {
            formats::Medium medium = forward_medium(albedo, 0);
            medium.eta = eta;
            const auto [once, rest] =
                half_space_reflectance(static_cast<double>(albedo), 0, static_cast<double>(eta));
            EXPECT_NEAR(share_scattered_once(medium), once / (once + rest), 0.05)
                << eta << " " << albedo;
        }
    }
}

TEST(ScatteredOnce, ShareIsThatOfTheBandThatAbsorbsMost) {
    formats::Medium coloured = forward_medium(0.95f, 0);
    coloured.sigma_s.g = 0.3f;
    coloured.sigma_a.g = 0.7f;
    formats::Medium dark = forward_medium(0.3f, 0);
    EXPECT_DOUBLE_EQ(share_scattered_once(coloured), share_scattered_once(dark));
}

// A forward peak scatters twice and more often before it returns, so that less than the share is
// lost in truth; what matters is that terms which hold nothing lose all of it, and all lose little.
TEST(ScatteredOnce, ErrorIsWhatTermsLoseOfThatShare) {
    const formats::Medium forward = forward_medium(0.9f, 0.9f);
    const double share = share_scattered_once(forward);
    EXPECT_NEAR(once_error(forward, 0), share, 1e-12);
    // Henyey-Greenstein: int p^2 = sum of (2 l + 1) g^2l = (1 + g^2) / (1 - g^2)^2, of which
    // degrees 0 to 4 are kept.
    const double q = 0.81;
    double kept = 0;
    for (int l = 0; l < 5; ++l) {
        kept += (2 * l + 1) * std::pow(q, l);
    }
    const double all = (1 + q) / ((1 - q) * (1 - q));
    EXPECT_NEAR(once_error(forward, 25), share * std::sqrt(1 - kept / all), 1e-5);
    EXPECT_EQ(once_error(forward_medium(0.9f, 0), 1), 0);
}

}  // namespace

}  // namespace opaline::bake
