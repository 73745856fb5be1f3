// Media so dense that light leaves where it entered: what a half space sends back, and that samples
// and light maps would find the same.
#include <gtest/gtest.h>

#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

// Albedo 0.9, 0.8, 0.5; `mean_free_path` [m] of red.
formats::Medium clay(float mean_free_path) {
    const float sigma = 1 / mean_free_path;
    formats::Medium medium;
    medium.sigma_s = {0.9f * sigma, 0.8f * sigma, 0.5f * sigma};
    medium.sigma_a = {0.1f * sigma, 0.2f * sigma, 0.5f * sigma};
    medium.eta = 1.3f;
    return medium;
}

BakeResult bake_spread(const formats::Scene& scene, bool forced) {
    BakeOptions options = tests::only({"multiple", "single"});
    options.coefficients = kAllCoefficients;
    options.simulate_all = forced;
    return tests::bake_scene(scene, options);
}

const PlanEntry& spread_of(const BakeResult& result) {
    return *find_entry(result.plan, "multiple.spread", 0);
}

TEST(Spread, OfADenseSmoothBodyIsLeftOutAndSamplesFindTheSame) {
    const auto scene = tests::make_translucent_scene({tests::make_sphere(5)}, clay(5e-5f));
    const BakeResult local = bake_spread(scene, false), spread = bake_spread(scene, true);
    ASSERT_FALSE(spread_of(local).on) << spread_of(local).bound;
    EXPECT_TRUE(spread_of(spread).forced);
    EXPECT_FALSE(tests::has_stage(local, "samples of "));
    EXPECT_FALSE(tests::has_stage(local, "light maps of "));
    EXPECT_TRUE(tests::has_stage(spread, "samples of "));
    EXPECT_GT(local.error.receivers_checked, 20u);
    EXPECT_LT(local.error.at_receivers.rms_relative, 0.05) << "suns on a cube map of 8";
    const auto b = tests::relight(spread.asset.view(), "white");
    EXPECT_GT(b[0].g, 0.1f);
    // What samples, light maps and codes err by.
    EXPECT_LE(tests::largest_difference(local.asset, spread.asset, "white"),
              spread_of(local).bound + 0.005 * double{b[0].r});
}

TEST(Spread, IsSimulatedAsSoonAsItCouldShow) {
    const auto plan_of = [](const formats::Scene& scene) {
        return *find_entry(plan_bake(scene, inspect_scene(scene), {}), "multiple.spread", 0);
    };
    const auto ball = [](unsigned level, const formats::Medium& medium) {
        return tests::make_translucent_scene({tests::make_sphere(level)}, medium);
    };
    EXPECT_FALSE(plan_of(ball(5, clay(5e-5f))).on);
    EXPECT_TRUE(plan_of(ball(5, clay(1e-3f))).on) << "light goes farther";
    EXPECT_TRUE(plan_of(ball(3, clay(5e-5f))).on) << "facets lean from their normals";
    const auto sheet = tests::make_translucent_scene(
        {tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 4)}, clay(5e-5f));
    EXPECT_TRUE(plan_of(sheet).on) << "an open surface may be thin";
    auto inverted = ball(5, clay(5e-5f));
    formats::Primitive& p = inverted.primitives[0];
    const glm::vec3 &a = p.position[p.index[0]], &b = p.position[p.index[1]],
                    &c = p.position[p.index[2]];
    // As scans have some: against its facet's, and a little too long.
    p.normal[p.index[0]] = -1.000001f * glm::normalize(glm::cross(b - a, c - a));
    EXPECT_TRUE(plan_of(inverted).on) << "a facet seen from behind";
    formats::Medium forward = clay(5e-5f);
    forward.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.6f, 0, {}, {}};
    EXPECT_TRUE(plan_of(ball(5, forward)).on) << "one band absorbs, and light leaves it in a peak";
    forward = tests::make_grey_medium(1.8e5f, 2e4f);
    forward.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.9f, 0, {}, {}};
    EXPECT_TRUE(plan_of(ball(5, forward)).on) << "walks hold light that leaves in a peak";
}

TEST(Spread, LeftOutCountsTowardTheErrorAskedFor) {
    const auto scene = tests::make_translucent_scene({tests::make_sphere(5)}, clay(5e-5f));
    const SceneFacts facts = inspect_scene(scene);
    Knobs knobs;
    EXPECT_FALSE(find_entry(plan_bake(scene, facts, knobs), "multiple.spread", 0)->on);
    knobs.error_target = 0.01;
    EXPECT_TRUE(find_entry(plan_bake(scene, facts, knobs), "multiple.spread", 0)->on);
}

}  // namespace
}  // namespace opaline::bake
