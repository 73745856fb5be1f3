// Effects that a surface or a medium is too dark for: what is left out is less than the plan's
// bound, and a little more is simulated.
// Phase functions that are nearly the same in all directions: one term, and what more would add.
#include <gtest/gtest.h>

#include <initializer_list>

#include "bake/scene/inspect_scene.h"
#include "runtime/specular.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

// Of single-scattering albedo `albedo`, its mean free path a tenth of the ball's radius.
formats::Scene dim_ball(float albedo) {
    formats::Medium medium;
    medium.sigma_s = {10 * albedo, 10 * albedo, 5 * albedo};
    medium.sigma_a = {10 - 10 * albedo, 10 - 10 * albedo, 10 - 5 * albedo};
    medium.eta = 1.3f;
    return tests::make_translucent_scene({tests::make_sphere(4)}, medium);
}

BakeResult bake_effects(const formats::Scene& scene, bool forced) {
    BakeOptions options = tests::small_bake();
    options.coefficients = kAllCoefficients;
    if (forced) simulate_all_but_bounces(options);
    return tests::bake_scene(scene, options);
}

const PlanEntry& entry_of(const BakeResult& result, const char* effect) {
    return *find_entry(result.plan, effect, 0);
}

// What was left out is something, and no more than `bound` where nothing is brighter than 1. So is
// what a body returns of a sun that lights it as a white sky does, by its irradiance.
void expect_within(double bound, const BakeResult& chosen, const BakeResult& all) {
    const double difference = tests::largest_difference(chosen.asset, all.asset, "white");
    EXPECT_GT(difference, 0) << "nothing was forced";
    EXPECT_LE(difference, bound);
    EXPECT_LE(tests::largest_difference(chosen.asset, all.asset, "studio"),
              bound * tests::peak_of("studio"));
    EXPECT_LE(tests::largest_difference(chosen.asset, all.asset, "sun:30,60"), bound);
}

TEST(SkippedEffects, ReflectionOfANearlyBlackSurfaceIsLessThanItsBound) {
    const auto scene_of = [](float albedo) {
        auto scene = tests::make_scene({tests::make_sphere(3)});
        scene.materials[0].base_color = {albedo, 0.5f * albedo, 0};
        return scene;
    };
    const BakeResult chosen = bake_effects(scene_of(0.0019f), false),
                     all = bake_effects(scene_of(0.0019f), true);
    ASSERT_FALSE(entry_of(chosen, "direct").on);
    EXPECT_TRUE(entry_of(all, "direct").forced);
    // The sky of a cube map of 8 x 8 texels a face is 1 % too bright from above.
    expect_within(1.01 * entry_of(chosen, "direct").bound, chosen, all);
    EXPECT_TRUE(entry_of(bake_effects(scene_of(0.002f), false), "direct").on);
}

// Of a ball of albedo `dark` these effects are left out, of a `brighter` one no longer the first.
BakeResult expect_left_out(std::initializer_list<const char*> effects, float dark, float brighter) {
    BakeResult chosen = bake_effects(dim_ball(dark), false);
    const BakeResult all = bake_effects(dim_ball(dark), true);
    double bound = 0;
    for (const char* effect : effects) {
        EXPECT_FALSE(entry_of(chosen, effect).on) << effect << entry_of(chosen, effect).bound;
        EXPECT_TRUE(entry_of(all, effect).forced) << effect;
        bound += entry_of(chosen, effect).bound;
    }
    expect_within(bound, chosen, all);
    EXPECT_TRUE(entry_of(bake_effects(dim_ball(brighter), false), *effects.begin()).on);
    return chosen;
}

TEST(SkippedEffects, MultipleScatteringOfADarkMediumIsLessThanItsBound) {
    const BakeResult chosen = expect_left_out({"multiple"}, 0.01f, 0.02f);
    EXPECT_TRUE(entry_of(chosen, "single").on);
}

TEST(SkippedEffects, SingleScatteringOfABlackMediumIsLessThanItsBound) {
    expect_left_out({"single", "multiple"}, 0.003f, 0.004f);
}

TEST(SkippedEffects, BoundaryOfIndexOneMirrorsNothing) {
    const auto bake_of = [](float eta, bool forced) {
        auto scene = dim_ball(0.5f);
        scene.materials[0].medium->eta = eta;
        BakeOptions options = tests::only({"specular"});
        options.simulate_all = forced;
        return tests::bake_scene(scene, options);
    };
    constexpr float kJustPast = 1.001f;
    const BakeResult chosen = bake_of(1, false), all = bake_of(1, true);
    const BakeResult past = bake_of(kJustPast, false);
    ASSERT_FALSE(entry_of(chosen, "specular").on);
    EXPECT_TRUE(entry_of(all, "specular").forced);
    EXPECT_EQ(entry_of(chosen, "specular").bound, 0);
    EXPECT_TRUE(chosen.asset.openness.empty());
    EXPECT_FALSE(all.asset.openness.empty());
    EXPECT_TRUE(entry_of(past, "specular").on);
    EXPECT_FALSE(entry_of(past, "specular").forced);
    const runtime::SpecularLight mirrored =
        runtime::prefilter_specular(bake::make_environment("white").value(),
                                    runtime::roughness_levels(all.asset.view()), {}, 0);
    runtime::ShadeOptions seen;
    seen.specular = &mirrored;
    seen.eye = {1.2f, 0, 0};
    const auto brightest = [&](const BakeResult& result) {
        std::vector<formats::Rgb> radiance(result.asset.position.size());
        runtime::shade(result.asset.view(), tests::make_light("white", 8), radiance, seen);
        float most = 0;
        for (const formats::Rgb& color : radiance) {
            most = std::max(most, color.g);
        }
        return most;
    };
    EXPECT_EQ(brightest(chosen), 0);
    EXPECT_LE(brightest(all), 1e-5f) << "rounding";
    EXPECT_GT(brightest(past), 1e-4f);
}

formats::Scene phase_ball(
    float g, formats::PhaseFunction::Type type = formats::PhaseFunction::Type::henyey_greenstein) {
    formats::Medium medium = tests::make_grey_medium(6, 4, 1.3f);
    medium.phase.type = type;
    medium.phase.g = g;
    return tests::make_translucent_scene({tests::make_sphere(3)}, medium);
}

BakeResult bake_skipped_terms(const formats::Scene& scene, std::uint32_t terms) {
    BakeOptions options = tests::small_bake();
    options.set(kPhaseTerms, terms);
    return tests::bake_scene(scene, options);
}

const PlanEntry& terms_of(const BakeResult& result) {
    return *find_entry(result.plan, "single.terms", 0);
}

constexpr float kNearlyIsotropic = 0.02f, kJustPast = 0.03f;

TEST(SkippedTerms, OfANearlyIsotropicMediumAddLessThanTheirBoundFromAnyEye) {
    const auto scene = phase_ball(kNearlyIsotropic);
    const BakeResult one = bake_skipped_terms(scene, 0), sixteen = bake_skipped_terms(scene, 16);
    ASSERT_FALSE(terms_of(one).on) << terms_of(one).reason;
    EXPECT_EQ(terms_of(one).terms, 1u);
    EXPECT_TRUE(terms_of(sixteen).on);
    EXPECT_EQ(one.asset.primitives[0].terms, 1u);
    EXPECT_EQ(sixteen.asset.primitives[0].terms, 16u);
    EXPECT_LT(one.asset.transport.index16.size(), sixteen.asset.transport.index16.size());
    runtime::ShadeOptions seen;
    for (const formats::Vec3 eye : {formats::Vec3{5, 0, 0}, {-2, 4, 1}, {0, 0.5f, -20}}) {
        seen.eye = eye;
        const double white = tests::largest_difference(one.asset, sixteen.asset, "white", seen);
        EXPECT_GT(white, 0) << "nothing was added";
        EXPECT_LE(white, terms_of(one).bound);
        EXPECT_LE(tests::largest_difference(one.asset, sixteen.asset, "studio", seen),
                  terms_of(one).bound * tests::peak_of("studio"));
    }
}

TEST(SkippedTerms, AreSimulatedAsSoonAsTheyCouldShow) {
    const BakeResult past = bake_skipped_terms(phase_ball(kJustPast), 0);
    EXPECT_TRUE(terms_of(past).on && !terms_of(past).forced) << terms_of(past).reason;
    EXPECT_EQ(terms_of(past).terms, 4u);
    EXPECT_EQ(past.asset.primitives[0].terms, 4u);
}

TEST(SkippedTerms, AreForcedWithEverythingElse) {
    BakeOptions options;
    options.simulate_all = true;
    options.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
    const auto scene = phase_ball(kNearlyIsotropic);
    const auto plan = plan_bake(scene, inspect_scene(scene), *resolve_knobs(options));
    const PlanEntry& entry = *find_entry(plan, "single.terms", 0);
    EXPECT_TRUE(entry.on && entry.forced);
    EXPECT_EQ(entry.terms, 4u);
    EXPECT_TRUE(entry.reason.starts_with("4 terms of the phase function")) << entry.reason;
}

// There is nothing to simulate, whoever asks for it.
TEST(SkippedTerms, OfAnIsotropicMediumDoNotExist) {
    for (const std::uint32_t terms : {0u, 16u}) {
        const BakeResult result =
            bake_skipped_terms(phase_ball(0, formats::PhaseFunction::Type::isotropic), terms);
        EXPECT_EQ(find_entry(result.plan, "single.terms", 0), nullptr);
        EXPECT_EQ(result.asset.primitives[0].terms, 1u);
    }
}

TEST(SkippedTerms, CostNothingWhereNothingScattersOnce) {
    BakeOptions options = tests::only({"multiple"});
    options.set(kPhaseTerms, 16);
    const BakeResult result = tests::bake_scene(phase_ball(0.5f), options);
    EXPECT_FALSE(terms_of(result).on);
    EXPECT_EQ(terms_of(result).terms, 0u);
    EXPECT_EQ(result.asset.primitives[0].terms, 1u);
}

}  // namespace

}  // namespace opaline::bake
