#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <string>

#include "bake/effects/incident/incident.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"
#include "bake/plan/row_layout.h"
#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

TEST(BakePlan, ImpossibleKnobsAreUsageErrors) {
    for (const std::uint32_t size : {1u, 7u, 24u, 256u}) {
        BakeOptions options;
        options.cubemap_size = size;
        const auto knobs = resolve_knobs(options);
        ASSERT_FALSE(knobs) << size;
        EXPECT_EQ(knobs.error().kind, formats::ErrorKind::usage);
    }
    BakeOptions options;
    options.coefficients = 6;
    EXPECT_FALSE(resolve_knobs(options));
}

TEST(BakePlan, MoreCoefficientsThanTexelsMeansAll) {
    BakeOptions options;
    options.cubemap_size = 8;
    options.coefficients = 384;
    ASSERT_TRUE(resolve_knobs(options));
    EXPECT_EQ(resolve_knobs(options)->coefficients, kAllCoefficients);
}

TEST(BakePlan, BlackSurfacesAreNotSimulated) {
    auto scene = tests::make_scene({tests::make_sphere(1), tests::make_sphere(1)});
    scene.materials.push_back({.name = "Black", .base_color = {0, 0, 0}});
    scene.primitives[1].material = 1;
    const auto plan = plan_bake(scene, inspect_scene(scene), {});
    const PlanEntry* const grey = find_entry(plan, "direct", 0);
    const PlanEntry* const black = find_entry(plan, "direct", 1);
    ASSERT_TRUE(grey != nullptr && black != nullptr);
    EXPECT_TRUE(grey->on);
    EXPECT_FALSE(black->on);
    EXPECT_EQ(black->bound, 0);
    EXPECT_FALSE(find_entry(plan, "light.visibility", 1)->on) << "nobody would see it";
}

TEST(BakePlan, UnusedMaterialsAreNotMentioned) {
    auto scene = tests::make_scene({tests::make_sphere(1)});
    scene.materials.push_back({.name = "Unused"});
    for (const PlanEntry& entry : plan_bake(scene, inspect_scene(scene), {})) {
        EXPECT_EQ(entry.subject.index, 0u);
    }
}

TEST(BakePlan, EverythingForcedLeavesNothingOutForItsBound) {
    auto scene = tests::make_scene({tests::make_sphere(3), tests::make_sphere(1)});
    scene.materials.push_back({.name = "Ink"});
    formats::Medium& ink = scene.materials[1].medium.emplace();
    ink.sigma_s = {1e-3f, 1e-3f, 1e-3f};
    ink.sigma_a = {1e3f, 1e3f, 1e3f};
    ink.eta = 1;
    scene.primitives[1].material = 1;
    BakeOptions options;
    options.simulate_all = true;
    const SceneFacts facts = inspect_scene(scene);
    for (const auto& [effect, material] :
         {std::pair("multiple", 1u), {"single", 1u}, {"specular", 1u}}) {
        const auto chosen = plan_bake(scene, facts, {});
        const auto all = plan_bake(scene, facts, *resolve_knobs(options));
        const PlanEntry* const off = find_entry(chosen, effect, material);
        const PlanEntry* const on = find_entry(all, effect, material);
        EXPECT_FALSE(off->on || off->forced) << effect;
        EXPECT_TRUE(on->on && on->forced) << effect;
        EXPECT_EQ(on->bound, off->bound) << effect;
        EXPECT_NE(on->reason.find("forced"), std::string::npos) << on->reason;
    }
    // What is worth it anyway is not called forced.
    const auto all = plan_bake(scene, facts, *resolve_knobs(options));
    EXPECT_TRUE(find_entry(all, "direct", 0)->on);
    EXPECT_FALSE(find_entry(all, "direct", 0)->forced);
}

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

struct Decision {
    PlanEntry colour;
    RowLayout layout;
};

Decision decide(const formats::Medium& medium, const Knobs& knobs = {}) {
    const auto scene = tests::make_translucent_scene({tests::make_sphere(2)}, medium);
    const auto plan = plan_bake(scene, inspect_scene(scene), knobs);
    return {*find_entry(plan, "light.colour", 0), layout_rows(scene, plan, knobs)[0]};
}

TEST(RuleColour, EqualBandsNeedOneAndNothingIsLost) {
    const Decision decision = decide(tests::make_grey_medium(10, 0.2f));
    EXPECT_FALSE(decision.colour.on);
    EXPECT_EQ(decision.colour.bound, 0);
    EXPECT_EQ(decision.layout.bands(), 1u);
}

TEST(RuleColour, BandsThatDifferByOneBitAreKept) {
    for (const bool is_scattering : {false, true}) {
        formats::Medium medium = tests::make_grey_medium(10, 0.2f);
        float& blue = is_scattering ? medium.sigma_s.b : medium.sigma_a.b;
        blue = std::nextafter(blue, 100.0f);
        const Decision decision = decide(medium);
        EXPECT_TRUE(decision.colour.on);
        EXPECT_FALSE(decision.colour.forced);
        EXPECT_GT(decision.colour.bound, 0);
        EXPECT_EQ(decision.layout.bands(), 3u);
    }
}

TEST(RuleColour, AllEffectsForceThreeBands) {
    Knobs knobs;
    knobs.simulate_all = true;
    const Decision decision = decide(tests::make_grey_medium(10, 0.2f), knobs);
    EXPECT_TRUE(decision.colour.on && decision.colour.forced);
    EXPECT_EQ(decision.layout.bands(), 3u);
}

// Of a medium of which nothing is simulated, rows are zero in every band.
TEST(RuleColour, WhatIsNotSimulatedHasNoColour) {
    formats::Medium medium = tests::make_grey_medium(10, 0.2f);
    medium.sigma_a.b = 5;
    EXPECT_EQ(decide(medium).layout.bands(), 3u);
    Knobs knobs;
    knobs.effects = {"specular"};
    const Decision decision = decide(medium, knobs);
    EXPECT_FALSE(decision.colour.on);
    EXPECT_EQ(decision.colour.bound, 0);
    EXPECT_EQ(decision.layout.bands(), 1u);
}

}  // namespace

}  // namespace opaline::bake
