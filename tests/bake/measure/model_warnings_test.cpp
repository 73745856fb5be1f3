#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/effects.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

std::vector<formats::Diagnostic> describe_forward(float g, std::uint32_t terms) {
    auto medium = tests::make_grey_medium(10, 0.1f);
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, g, 0, {}, {}};
    const auto scene = tests::make_translucent_scene({tests::make_sphere(1)}, medium);
    PlanEntry entry;
    entry.subject.name = "material 'Grey'";
    entry.on = true;
    entry.terms = terms;
    const MaterialFacts unknown;
    Knobs knobs;
    knobs.set(kPhaseTerms, terms);
    std::vector<formats::Diagnostic> warnings;
    all_effects()[Effect::single].rules[1].warn({scene.materials[0], unknown, knobs}, entry,
                                                warnings);
    return warnings;
}

TEST(ShortSeries, StrongForwardScatteringIsSaidToNeedMoreTermsThanThereAre) {
    const auto warnings = describe_forward(0.9f, 25);
    ASSERT_FALSE(warnings.empty());
    EXPECT_THAT(warnings[0].fault, ::testing::HasSubstr("25 terms"));
    EXPECT_THAT(warnings[0].fault, ::testing::HasSubstr("negative"));
    EXPECT_THAT(warnings[0].remedy, ::testing::HasSubstr("--effects multiple"));
}

TEST(ShortSeries, PhaseFunctionsThatTheTermsResolveAreNotMentioned) {
    EXPECT_TRUE(describe_forward(0.3f, 25).empty());
    // Fewer terms than needed are another matter: --phase-terms.
    for (const formats::Diagnostic& other : describe_forward(0.9f, 9)) {
        EXPECT_THAT(other.fault, ::testing::Not(::testing::HasSubstr("narrow")));
    }
}

}  // namespace
}  // namespace opaline::bake
