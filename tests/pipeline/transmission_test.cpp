// Light that crosses a body unscattered: what a clear body shows, and when it is left out.
#include <gtest/gtest.h>

#include "bake/check/check_model.h"
#include "bake/effects/transmission/rules_transmission.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"
#include "tests/support/walk_bake.h"

namespace opaline::bake {
namespace {

formats::Scene clear_ball(float sigma_s, float sigma_a, float eta = 1.3f) {
    return tests::make_translucent_scene({tests::make_sphere(2)},
                                         tests::make_grey_medium(sigma_s, sigma_a, eta));
}

// 1 less what the boundary mirrors along the normal.
TEST(Transmission, AClearBallIsBakedByItAloneAndShowsAFurnaceAsItIs) {
    const BakeResult baked = tests::bake_scene(clear_ball(0, 1e-6f, 1.5f), tests::small_bake());
    EXPECT_FALSE(entry_of(baked, "multiple").on);
    EXPECT_FALSE(entry_of(baked, "single").on);
    ASSERT_TRUE(entry_of(baked, "transmission").on);
    EXPECT_TRUE(tests::all_finite(baked.asset));
    for (const formats::Rgb& c : tests::relight(baked.asset.view(), "white")) {
        ASSERT_NEAR(c.g, 0.96, 0.02);
    }
    EXPECT_NEAR(tests::mean_green(tests::relight(baked.asset.view(), "white")), 0.96, 0.003);
}

TEST(Transmission, OfABodyThatIsTooDenseIsLessThanItsBoundAndOfAClearerOneMoreThanTheThreshold) {
    BakeOptions options = tests::only({"transmission"});
    options.set(kStraightTerms, 1);  // the mean over views, which the bound is of
    for (const float eta : {1.0f, 1.3f}) {
        const float dense = eta == 1 ? 260.0f : 56.0f;
        const BakeResult chosen = tests::bake_scene(clear_ball(0, dense, eta), options);
        ASSERT_FALSE(entry_of(chosen, "transmission").on) << entry_of(chosen, "transmission").bound;
        BakeOptions all = options;
        simulate_all_but_bounces(all);
        const BakeResult forced = tests::bake_scene(clear_ball(0, dense, eta), all);
        EXPECT_TRUE(entry_of(forced, "transmission").forced);
        EXPECT_LE(tests::largest_difference(chosen.asset, forced.asset, "white"),
                  entry_of(chosen, "transmission").bound);
        const BakeResult clearer = tests::bake_scene(clear_ball(0, 1.5f, eta), options);
        ASSERT_TRUE(entry_of(clearer, "transmission").on);
        const double shown = tests::largest_difference(chosen.asset, clearer.asset, "white");
        EXPECT_GT(shown, kLeastBound);
        EXPECT_LT(shown, entry_of(clearer, "transmission").bound);
    }
}

TEST(Transmission, RowsByViewAreTakenWhereTheyShowAndChangeLessThanTheirBound) {
    BakeOptions options = tests::only({"transmission"});
    const BakeResult dim = tests::bake_scene(clear_ball(0, 2.5f), options);
    EXPECT_FALSE(entry_of(dim, "transmission.view").on);
    options.set(kStraightTerms, 4);
    const BakeResult four = tests::bake_scene(clear_ball(0, 2.5f), options);
    ASSERT_TRUE(entry_of(four, "transmission.view").on);
    EXPECT_EQ(four.asset.primitives[0].terms, 4u);
    EXPECT_LT(tests::largest_difference(dim.asset, four.asset, "white"),
              entry_of(dim, "transmission.view").bound);
    options = tests::only({"transmission"});
    const BakeResult bright = tests::bake_scene(clear_ball(0, 0.1f), options);
    ASSERT_TRUE(entry_of(bright, "transmission.view").on);
    options.set(kStraightTerms, 1);
    const BakeResult one = tests::bake_scene(clear_ball(0, 0.1f), options);
    EXPECT_EQ(one.asset.primitives[0].terms, 1u);
    EXPECT_GT(tests::largest_difference(bright.asset, one.asset, "sun:30,60"), 0.05)
        << "they see the sun from one side";
}

TEST(Transmission, AgreesWithTheReferencesUnscatteredTermUnderEvenLight) {
    const formats::Scene scene =
        tests::make_translucent_scene({tests::make_sphere(3)}, tests::make_grey_medium(0.4f, 0.4f));
    BakeOptions options = tests::only({"transmission"});
    options.quality = Quality::production;
    options.cubemap_size = 16;
    const BakeResult baked = tests::bake_scene(scene, options);
    EXPECT_EQ(held_light(all_effects(), baked.plan),
              ModelCheckOptions().simulated | TermSet::unscattered);
    ModelCheckOptions wanted;
    wanted.simulated = TermSet::unscattered;
    wanted.max_events = 50000;
    wanted.receivers = 24;
    const auto report = check_model(scene, baked.asset.view(), wanted, {}).value();
    ASSERT_EQ(report.by_light[0].name, "white");
    EXPECT_LT(std::abs(report.by_light[0].bias), 0.02 + 2 * report.by_light[0].noise / 4)
        << "nine rows along the normal of 24 receivers";
    EXPECT_LT(report.by_light[0].rms_relative, 0.04);
}

TEST(Transmission, StandsInTheRowOfMultipleScatteringWhereTermsAreApart) {
    const formats::Scene scene = clear_ball(0.5f, 0.1f);
    BakeOptions options = tests::small_bake();
    options.separate_terms = true;
    const BakeResult all = tests::bake_scene(scene, options);
    options.effects = {"multiple", "single"};
    const BakeResult scattered = tests::bake_scene(scene, options);
    ASSERT_TRUE(all.asset.primitives[0].is_separate());
    EXPECT_EQ(all.asset.primitives[0].terms, scattered.asset.primitives[0].terms);
    runtime::ShadeOptions single;
    single.terms = formats::TermSet::single;
    EXPECT_EQ(tests::largest_difference(all.asset, scattered.asset, "white", single), 0);
    runtime::ShadeOptions multiple;
    multiple.terms = formats::TermSet::multiple;
    EXPECT_GT(tests::largest_difference(all.asset, scattered.asset, "white", multiple), 0.2);
}

TEST(Transmission, ItsSelfCheckFindsFewViewsWorseThanMany) {
    BakeOptions options = tests::only({"transmission"});
    options.set(kStraightViews, 16);
    const BakeResult few = tests::bake_scene(clear_ball(0, 0.5f), options);
    options.set(kStraightViews, 256);
    const BakeResult many = tests::bake_scene(clear_ball(0, 0.5f), options);
    EXPECT_LT(many.error.at_receivers.by_light[0].rms_relative, 0.03) << "white";
    EXPECT_LT(many.error.at_receivers.rms_relative, few.error.at_receivers.rms_relative);
    // The truth lets views be darker than nothing; rows do not.
    EXPECT_LT(many.error.at_receivers.rms_relative, 0.4) << "suns between views";
}

}  // namespace
}  // namespace opaline::bake
