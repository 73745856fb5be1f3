// Media that vary in space, in plans and whole bakes: against path tracing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/check/check_model.h"
#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/varied_media.h"
#include "tests/support/walk_bake.h"

namespace opaline::bake {
namespace {

using ::testing::HasSubstr;

tests::Scene make_veined_ball(formats::Medium medium, int levels) {
    medium.variation.emplace();
    medium.variation->marble = formats::Marble{0.9f, {{0.3f, 0.1f, 0.1f}, {1, 1, 1}}};
    return tests::make_translucent_scene({tests::make_sphere(levels)}, medium);
}

BakeOptions scattering(double model, double walks = 200000) {
    BakeOptions options = bake_by(model, walks);
    options.effects = {"multiple", "single"};
    return options;
}

auto model_errors(const tests::Scene& scene, const BakeResult& baked) {
    ModelCheckOptions check;
    check.simulated = TermSet::multiple | TermSet::single;
    check.receivers = 16;
    check.max_events = 1000000;
    const auto report = check_model(scene, baked.asset.view(), check, {});
    EXPECT_TRUE(report);
    return report.value().by_light.front();
}

// So thick that the dipole would be taken, and so dense that light would leave where it entered.
TEST(VariedMedia, ArePlannedByRandomWalksWhichHoldAllLightWhateverTheQuality) {
    for (const float sigma_s : {4.0f, 40.0f, 4e6f}) {
        const tests::Scene scene =
            make_veined_ball(tests::make_grey_medium(sigma_s, 0.01f * sigma_s), 2);
        const SceneFacts facts = inspect_scene(scene);
        for (const Quality quality : {Quality::draft, Quality::production}) {
            BakeOptions options;
            options.quality = quality;
            const Knobs knobs = resolve_knobs(all_effects(), options).value();
            const auto plan = plan_bake(all_effects(), scene, facts, knobs);
            const PlanEntry& model = *find_entry(plan, "multiple.model", 0);
            EXPECT_TRUE(model.on && model.all_orders) << sigma_s;
            EXPECT_EQ(model.choice, "walks");
            EXPECT_THAT(model.reason, HasSubstr("varies in space"));
            const PlanEntry& single = *find_entry(plan, "single", 0);
            EXPECT_FALSE(single.on);
            EXPECT_TRUE(single.all_orders);
            EXPECT_TRUE(find_entry(plan, "multiple.spread", 0)->on) << sigma_s;
            EXPECT_TRUE(find_entry(plan, "light.colour", 0)->on);
        }
    }
}

TEST(VariedMedia, BakedBallWithVeinsInsideIsAsBrightAsPathTracedAndItsMeanIsNot) {
    const tests::Scene ball = make_veined_ball(tests::make_grey_medium(7.84f, 0.16f), 2);
    const BakeResult walked = tests::bake_scene(ball, scattering(kWalked, 100000));
    EXPECT_FALSE(entry_of(walked, "single").on);
    EXPECT_TRUE(walked.warnings.empty());
    EXPECT_LT(model_errors(ball, walked).rms_relative, 0.08);
    const BakeResult even = tests::bake_scene(ball, scattering(kDipole));
    ASSERT_FALSE(even.warnings.empty());
    EXPECT_THAT(even.warnings[0].fault, HasSubstr("varies from point to point"));
    EXPECT_TRUE(entry_of(even, "single").on);
    EXPECT_GT(model_errors(ball, even).rms_relative, 0.2);
    const auto base = walked.asset.base_color;
    EXPECT_EQ(base.front(), base.back()) << "veins inside do not colour the light once more";
}

TEST(VariedMedia, OfLightScatteredOnceAloneThePlanSaysThatItNeedsWalks) {
    const tests::Scene ball = make_veined_ball(tests::make_grey_medium(4, 0.1f), 1);
    BakeOptions options = tests::only({"single"});
    options.set(kMultipleModel, 0);
    const BakeResult baked = tests::bake_scene(ball, options);
    EXPECT_FALSE(entry_of(baked, "single").on);
    EXPECT_THAT(entry_of(baked, "single").reason, HasSubstr("only random walks know it"));
}

}  // namespace
}  // namespace opaline::bake
