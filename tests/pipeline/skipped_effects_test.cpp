// Effects that a medium is too dark for: what is left out is less than the plan's bound, and a
// little more is simulated.
#include <gtest/gtest.h>

#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

// Of single-scattering albedo `albedo`, its mean free path a tenth of the ball's radius.
formats::Scene ball_of(float albedo) {
    formats::Medium medium;
    medium.sigma_s = {10 * albedo, 10 * albedo, 5 * albedo};
    medium.sigma_a = {10 - 10 * albedo, 10 - 10 * albedo, 10 - 5 * albedo};
    medium.eta = 1.3f;
    return tests::make_translucent_scene({tests::make_sphere(4)}, medium);
}

BakeResult bake(const formats::Scene& scene, bool forced) {
    BakeOptions options = tests::small_bake();
    options.coefficients = kAllCoefficients;
    options.simulate_all = forced;
    return tests::bake_scene(scene, options);
}

const PlanEntry& entry_of(const BakeResult& result, const char* effect) {
    return *find_entry(result.plan, effect, 0);
}

double largest_difference(const BakeResult& a, const BakeResult& b, const char* light) {
    const auto x = tests::relight(a.asset.view(), light), y = tests::relight(b.asset.view(), light);
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        largest = std::max({largest, std::abs(double{x[i].r} - y[i].r),
                            std::abs(double{x[i].g} - y[i].g), std::abs(double{x[i].b} - y[i].b)});
    }
    return largest;
}

TEST(SkippedEffects, MultipleScatteringOfADarkMediumIsLessThanItsBound) {
    const auto scene = ball_of(0.01f);
    const BakeResult chosen = bake(scene, false), all = bake(scene, true);
    ASSERT_FALSE(entry_of(chosen, "multiple").on) << entry_of(chosen, "multiple").bound;
    ASSERT_TRUE(entry_of(chosen, "single").on);
    EXPECT_TRUE(entry_of(all, "multiple").forced);
    const double difference = largest_difference(chosen, all, "white");
    EXPECT_GT(difference, 0) << "nothing was forced";
    EXPECT_LE(difference, entry_of(chosen, "multiple").bound);
    EXPECT_TRUE(entry_of(bake(ball_of(0.02f), false), "multiple").on);
}

TEST(SkippedEffects, SingleScatteringOfABlackMediumIsLessThanItsBound) {
    const auto scene = ball_of(0.003f);
    const BakeResult chosen = bake(scene, false), all = bake(scene, true);
    ASSERT_FALSE(entry_of(chosen, "single").on) << entry_of(chosen, "single").bound;
    ASSERT_FALSE(entry_of(chosen, "multiple").on);
    EXPECT_TRUE(entry_of(all, "single").forced);
    const double difference = largest_difference(chosen, all, "white");
    EXPECT_GT(difference, 0) << "nothing was forced";
    EXPECT_LE(difference, entry_of(chosen, "single").bound + entry_of(chosen, "multiple").bound);
    EXPECT_TRUE(entry_of(bake(ball_of(0.004f), false), "single").on);
}

TEST(SkippedEffects, BoundaryOfIndexOneMirrorsNothing) {
    auto scene = ball_of(0.5f);
    scene.materials[0].medium->eta = 1;
    const BakeResult chosen = bake(scene, false), all = bake(scene, true);
    ASSERT_FALSE(entry_of(chosen, "specular").on);
    EXPECT_EQ(entry_of(chosen, "specular").bound, 0);
    EXPECT_TRUE(chosen.asset.openness.empty());
    EXPECT_FALSE(all.asset.openness.empty());
    // Codes of 8 bits, of rows that are otherwise traced.
    constexpr double kRounding = 0.005;
    EXPECT_LE(largest_difference(chosen, all, "white"), kRounding);
    EXPECT_TRUE(entry_of(bake(ball_of(0.5f), false), "specular").on);
}

}  // namespace
}  // namespace opaline::bake
