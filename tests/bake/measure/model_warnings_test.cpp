#include "bake/measure/model_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/media.h"

namespace opaline::bake {
namespace {

std::vector<formats::Diagnostic> describe_forward(float g, std::uint32_t terms) {
    auto medium = tests::make_grey_medium(10, 0.1f);
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, g, 0, {}, {}};
    const auto scene = tests::make_translucent_scene({tests::make_sphere(1)}, medium);
    PlanEntry entry;
    entry.subject = "material 'Grey'";
    entry.on = true;
    entry.terms = terms;
    return describe_short_series(scene, {entry}, Knobs{});
}

TEST(ShortSeries, StrongForwardScatteringIsSaidToNeedMoreTermsThanThereAre) {
    const auto warnings = describe_forward(0.9f, 25);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0].fault, ::testing::HasSubstr("25 terms"));
    EXPECT_THAT(warnings[0].fault, ::testing::HasSubstr("negative"));
    EXPECT_THAT(warnings[0].remedy, ::testing::HasSubstr("--effects multiple"));
}

TEST(ShortSeries, PhaseFunctionsThatTheTermsResolveAreNotMentioned) {
    EXPECT_TRUE(describe_forward(0.3f, 25).empty());
    // Fewer terms than needed are another matter: --phase-terms.
    EXPECT_TRUE(describe_forward(0.9f, 9).empty());
}

}  // namespace
}  // namespace opaline::bake
