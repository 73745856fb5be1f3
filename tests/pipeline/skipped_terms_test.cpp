// Phase functions that are nearly the same in all directions: one term, and what more would add.
#include <gtest/gtest.h>

#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

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
