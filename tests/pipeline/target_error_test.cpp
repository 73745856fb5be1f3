#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "bake/effects/interreflection/interreflection.h"
#include "formats/opal/write_opal.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

// Soft light inside, and no shadow's edge on it.
formats::Scene soft_ball() {
    return tests::make_translucent_scene({tests::make_sphere(3)},
                                         tests::make_grey_medium(4, 0.02f));
}

BakeOptions asking_for(double error) {
    BakeOptions options;
    options.error = error;
    options.threads = 2;
    return options;
}

TEST(TargetError, MeasuredErrorIsWhatWasAskedForAndLessCostsMore) {
    const auto scene = soft_ball();
    std::uint64_t bytes = 0;
    for (const double error : {0.1, 0.03}) {
        const BakeResult result = tests::bake_scene(scene, asking_for(error));
        ASSERT_TRUE(result.accuracy);
        EXPECT_TRUE(result.accuracy->met) << error;
        EXPECT_LE(result.accuracy->predicted, error);
        EXPECT_LE(result.error.at_receivers.rms_relative, error);
        EXPECT_LE(result.error.between.rms_relative, error);
        EXPECT_EQ(result.asset.primitives[0].bands, 1u) << "a grey medium";
        // What was not needed was not bought.
        EXPECT_GT(result.error.at_receivers.rms_relative, 0.2 * error);
        const std::uint64_t size = formats::opal_size(result.asset.view());
        EXPECT_GT(size, bytes) << error;
        bytes = size;
    }
}

TEST(TargetError, GivenKnobsStay) {
    BakeOptions options = asking_for(0.1);
    options.cubemap_size = 8;
    options.coefficients = 40;
    options.set(kEpsilon, 2e-3);
    options.set(kDepthSamples, 5);
    const BakeResult result = tests::bake_scene(soft_ball(), options);
    EXPECT_EQ(result.knobs.cubemap_size, 8u);
    EXPECT_EQ(result.knobs.coefficients, 40u);
    EXPECT_EQ(result.knobs[kEpsilon], 2e-3);
    EXPECT_EQ(result.knobs[kDepthSamples], 5u);
}

TEST(TargetError, SingleScatteringIsNeverGatheredOnMoreTexelsThanTheFileHas) {
    BakeOptions options = asking_for(1e-3);  // out of reach: every level of samples is tried
    options.cubemap_size = 8;
    options.effects = {"single"};
    const auto dense =
        tests::make_translucent_scene({tests::make_sphere(3)}, tests::make_grey_medium(40, 1));
    const BakeResult result = tests::bake_scene(dense, options);
    EXPECT_LE(result.knobs[kSingleCubemap], 8u);
    std::uint32_t levels = 0;
    for (const auto& [knobs, trial] : result.accuracy->trials) {
        levels += trial.knob == "depth_samples" ? 1 : 0;
    }
    EXPECT_GT(levels, 1u) << "the finer levels were not reached";
}

TEST(TargetError, OpaqueSurfacesTakeTheCoarsestCubeMapThatIsGoodEnough) {
    const auto ball = tests::make_scene({tests::make_sphere(3)});
    const BakeResult result = tests::bake_scene(ball, asking_for(0.05));
    EXPECT_TRUE(result.accuracy->met);
    EXPECT_LE(result.knobs.cubemap_size, 32u);
    EXPECT_LE(result.error.rms_relative, 0.05);
}

// Rays follow the target, before any is traced: that light is found before knobs are tried.
TEST(TargetError, IsMetWithTheLightOfOtherSurfaces) {
    const BakeResult result = tests::bake_scene(tests::make_dented_ball(), asking_for(0.05));
    ASSERT_TRUE(find_entry(result.plan, "interreflection", 0)->on);
    EXPECT_LT(result.knobs[kBounceRays], 144);
    EXPECT_LE(result.error.at_receivers.rms_relative, 0.05);
    EXPECT_GT(resolve_knobs(asking_for(0.01)).value()[kBounceRays], 576);
}

TEST(TargetError, OutOfReachIsSaidAndBytesThatLowerNothingAreNotSpent) {
    BakeOptions options = asking_for(1e-3);
    options.cubemap_size = 8;
    options.effects = {"direct"};
    const BakeResult result = tests::bake_scene(tests::make_dented_ball(), options);
    EXPECT_FALSE(result.accuracy->met);
    EXPECT_EQ(result.knobs.cubemap_size, 8u);
    EXPECT_LT(result.knobs.coefficients, 6u * 8 * 8);
    double least = 1;
    for (const auto& [knobs, trial] : result.accuracy->trials) {
        least = std::min(least, trial.knob == "coefficients" ? trial.error : 1.0);
    }
    EXPECT_LT(result.accuracy->predicted, 1.1 * least);
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_THAT(result.warnings.back().fault, ::testing::HasSubstr("out of reach"));
    EXPECT_THAT(result.warnings.back().remedy, ::testing::HasSubstr("--cubemap"));
}

// One term for light that goes on the way it came: no sample and no texel mends that.
TEST(TargetError, TooFewPhaseTermsEndThePilotAndAreNamed) {
    auto medium = tests::make_grey_medium(4, 0.4f);
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.95f, 0, {}, {}};
    BakeOptions options = asking_for(0.1);
    options.set(kPhaseTerms, 1);
    const BakeResult result =
        tests::bake_scene(tests::make_translucent_scene({tests::make_sphere(2)}, medium), options);
    EXPECT_FALSE(result.accuracy->met);
    std::set<std::pair<std::uint32_t, double>> rounds;
    for (const auto& [knobs, trial] : result.accuracy->trials) {
        rounds.insert({knobs.cubemap_size, knobs[kSamplesPerPath]});
    }
    EXPECT_LE(rounds.size(), 3u);
    EXPECT_LE(result.knobs.cubemap_size, 16u);
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_THAT(result.warnings.back().remedy, ::testing::HasSubstr("--phase-terms"));
}

}  // namespace
}  // namespace opaline::bake
