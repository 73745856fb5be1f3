#include "bake/plan/knobs.h"

#include <gtest/gtest.h>

#include <iterator>
#include <string>

#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

std::uint32_t kept_for(std::uint32_t coefficients) {
    Knobs knobs;
    knobs.coefficients = coefficients;
    return sample_coefficients(knobs);
}

TEST(SampleCoefficients, AreThoseOfARowUpTo512AndHalfOfThemFrom1024On) {
    EXPECT_EQ(kept_for(1), 1u);
    EXPECT_EQ(kept_for(128), 128u);
    EXPECT_EQ(kept_for(512), 512u);
    EXPECT_EQ(kept_for(700), 512u);
    EXPECT_EQ(kept_for(1024), 512u);
    EXPECT_EQ(kept_for(3000), 1500u);
    EXPECT_EQ(kept_for(kAllCoefficients), 4096u) << "memory has an end";
}

// "1" is coarser than "2" where the knob counts; where it is an error, the other way round.
TEST(Presets, NoKnobOfABetterOneIsCoarser) {
    const auto preset = [](Quality quality) {
        BakeOptions options;
        options.quality = quality;
        return *resolve_knobs(options);
    };
    const Quality order[] = {Quality::draft, Quality::preview, Quality::production,
                             Quality::reference};
    for (std::size_t q = 1; q < std::size(order); ++q) {
        const Knobs coarse = preset(order[q - 1]), fine = preset(order[q]);
        SCOPED_TRACE(std::string(quality_name(order[q - 1])) + " and " +
                     std::string(quality_name(order[q])));
        EXPECT_LE(coarse.cubemap_size, fine.cubemap_size);
        EXPECT_LE(coarse.coefficients, fine.coefficients);
        EXPECT_LE(coarse.code_bits, fine.code_bits);
        EXPECT_LE(coarse.exact_rays, fine.exact_rays);
        EXPECT_LE(sample_coefficients(coarse), sample_coefficients(fine));
        for (const KnobSpec* knob :
             {&kSamples, &kSamplesPerPath, &kDepthSamples, &kSingleCubemap}) {
            EXPECT_LE(coarse[*knob], fine[*knob]) << knob->name;
        }
        for (const KnobSpec* knob : {&kEpsilon, &kPhaseTolerance}) {
            EXPECT_GE(coarse[*knob], fine[*knob]) << knob->name;
        }
    }
}

TEST(Knobs, WhatTheModelLeavesOfATargetIsForTheNumbersAndHalfOfItAtLeast) {
    Knobs knobs;
    knobs.error_target = 0.05;
    EXPECT_DOUBLE_EQ(knobs.numerical_target(), 0.05);
    knobs.model_error = 0.03;
    EXPECT_DOUBLE_EQ(knobs.numerical_target(), 0.04) << "3, 4, 5";
    knobs.model_error = 0.049;
    EXPECT_DOUBLE_EQ(knobs.numerical_target(), 0.025);
}

// Where models err by m, the least error that can be asked for is m; the numbers may then err by
// m / 2. A target below m is missed in any case, and asks for no finer numbers than that.
TEST(Knobs, TargetThatModelsMissCostsNoMoreThanTheLeastThatTheyCanMeet) {
    const double model = 0.2;
    const auto begin = [&](double target) {
        BakeOptions options;
        options.error = target;
        return with_model_error(all_effects(), *resolve_knobs(all_effects(), options), model);
    };
    const Knobs reachable = begin(model), hopeless = begin(0.005);
    EXPECT_DOUBLE_EQ(reachable.numerical_target(), 0.1);
    EXPECT_DOUBLE_EQ(hopeless.numerical_target(), 0.1);
    EXPECT_EQ(hopeless.cubemap_size, reachable.cubemap_size);
    EXPECT_EQ(hopeless.coefficients, reachable.coefficients);
    for (const EffectDescriptor& effect : all_effects().effects) {
        for (const KnobSpec* knob : effect.knobs) {
            EXPECT_EQ(hopeless[*knob], reachable[*knob]) << knob->name;
        }
    }
    BakeOptions given;
    given.error = 0.005;
    given.cubemap_size = 32;
    given.set(kSamples, 5000);
    const Knobs kept = with_model_error(all_effects(), *resolve_knobs(all_effects(), given), model);
    EXPECT_EQ(kept.cubemap_size, 32u);
    EXPECT_EQ(kept[kSamples], 5000);
}

}  // namespace
}  // namespace opaline::bake
