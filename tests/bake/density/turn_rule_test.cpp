
#include <gtest/gtest.h>

#include <cmath>

#include "bake/trace/density/scaled_phase.h"
#include "tests/bake/scattering/phase_support.h"

namespace opaline::bake {
namespace {

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
