#include "bake/physics/path_integral/turn.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opaline::bake {
namespace {

TEST(ForwardSplit, OfHenyeyGreensteinIsThatOfTheMathematics) {
    const ForwardSplit split = split_forward_peak(expand_henyey_greenstein(0.9, 6), 4);
    EXPECT_NEAR(split.share, 0.590, 5e-4);
    ASSERT_EQ(split.rest.lambda.size(), 5u);
    const double expected[] = {1, 0.756, 0.536, 0.338, 0.160};
    for (std::size_t l = 0; l < 5; ++l) {
        EXPECT_NEAR(split.rest.lambda[l], expected[l], 5e-4) << l;
    }
}

TEST(ForwardSplit, MakesNarrowPeaksModerate) {
    for (const double g : {0.9, 0.99, 0.9999}) {
        const ForwardSplit split = split_forward_peak(expand_henyey_greenstein(g, 6), 4);
        EXPECT_LE(split.rest.lambda[1], 0.8) << g;
    }
}

// Along a path of length s the moment of degree l decays as exp(-c s + b lambda_l s).
TEST(ForwardSplit, KeepsEveryMomentOfLightThatIsScatteredAnyNumberOfTimes) {
    const Coefficients medium{3, 0.2};
    for (const double g : {-0.6, 0.0, 0.5, 0.9, 0.99, 0.9999}) {
        for (const unsigned degree : {1u, 2u, 4u, 8u}) {
            const PhaseSeries series = expand_henyey_greenstein(g, degree + 2);
            const ForwardSplit split = split_forward_peak(series, degree);
            const Coefficients rest = without_peak(medium, split.share);
            EXPECT_EQ(rest.absorption, medium.absorption);
            for (unsigned l = 0; l <= degree; ++l) {
                EXPECT_NEAR(rest.extinction() - rest.scattering * split.rest.lambda[l],
                            medium.extinction() - medium.scattering * series.lambda[l], 1e-14)
                    << g << ' ' << l;
            }
        }
    }
}

TEST(ForwardSplit, BackwardScatteringHasNoForwardPeak) {
    const PhaseSeries series = expand_henyey_greenstein(-0.5, 6);
    const ForwardSplit split = split_forward_peak(series, 4);
    EXPECT_EQ(split.share, 0);
    EXPECT_EQ(split.rest.lambda[3], series.lambda[3]);
}

}  // namespace
}  // namespace opaline::bake
