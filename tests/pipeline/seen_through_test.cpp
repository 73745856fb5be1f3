// Surfaces that are seen through clear bodies: light that met a surface and crossed a body without
// being scattered.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/check/model_pairs.h"
#include "bake/effects/transmission/rules_transmission.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

const std::vector<std::string> kStraight{"direct", "transmission"},
    kBetween{"direct", "interreflection"}, kThrough{"direct", "transmission", "interreflection"};

// A body of the medium above a floor of that albedo.
formats::Scene above_floor(tests::Primitive body, const formats::Medium& medium, float albedo) {
    tests::Primitive floor = tests::make_quad({-2, -1.1f, -2}, {0, 0, 4}, {4, 0, 0}, 10);
    floor.material = 1;
    formats::Scene scene = tests::make_translucent_scene({std::move(body), floor}, medium);
    scene.materials[1].base_color = {albedo, albedo, albedo};
    return scene;
}

formats::Scene ball_above_floor(float sigma_a, float albedo, float eta = 1.5f) {
    return above_floor(tests::make_sphere(2), tests::make_grey_medium(0, sigma_a, eta), albedo);
}

std::vector<formats::Rgb> shown_by(const formats::Scene& scene, std::vector<std::string> effects,
                                   std::size_t primitive) {
    return tests::relight_primitive(tests::bake_scene(scene, tests::only(std::move(effects))).asset,
                                    "white", primitive);
}

// All paths end in a sky of radiance 1. Along its normals the ball mirrors 4 %, which is no part of
// rows.
TEST(SeenThrough, AClearBallOverAWhiteFloorInAFurnaceShowsOneAndSoDoesTheFloor) {
    const BakeResult baked = tests::bake_scene(ball_above_floor(1e-6f, 1), tests::only(kThrough));
    const auto ball = tests::relight_primitive(baked.asset, "white", 0),
               floor = tests::relight_primitive(baked.asset, "white", 1);
    EXPECT_NEAR(tests::mean_green(ball), 0.96, 0.01);
    EXPECT_NEAR(tests::mean_green(floor), 1, 0.01);
    for (const formats::Rgb& c : ball) {
        EXPECT_NEAR(c.g, 0.96, 0.08);
    }
    for (const formats::Rgb& c : floor) {
        EXPECT_NEAR(c.g, 1, 0.08);
    }
    EXPECT_LT(tests::mean_green(shown_by(ball_above_floor(1e-6f, 1), kStraight, 0)), 0.8)
        << "what stands behind is black";
}

// Index 1 and no absorption: as if the block were not there. The floor sees nothing else.
TEST(SeenThrough, AMatchedClearBlockShowsTheFloorBehindItAndTheFloorTheSkyBehindTheBlock) {
    constexpr float kAlbedo = 0.5f;
    tests::Primitive block = tests::make_cube(6, false);
    for (glm::vec3& p : block.position) {
        p *= glm::vec3(1.5f, 0.4f, 1.5f);
    }
    const formats::Scene scene = above_floor(block, tests::make_grey_medium(0, 1e-6f, 1), kAlbedo);
    const BakeResult baked = tests::bake_scene(scene, tests::only(kThrough));
    EXPECT_NEAR(tests::mean_green(tests::relight_primitive(baked.asset, "white", 1)), kAlbedo,
                0.01);
    const auto of_block = tests::relight_primitive(baked.asset, "white", 0);
    double from_above = 0, count = 0;
    for (std::size_t v = 0; v < of_block.size(); ++v) {
        const glm::vec3 x = block.position[v];
        if (block.normal[v].y > 0.9f && std::max(std::abs(x.x), std::abs(x.z)) < 0.8f) {
            from_above += double{of_block[v].g};
            count += 1;
        }
    }
    ASSERT_GT(count, 0);
    EXPECT_NEAR(from_above / count, kAlbedo, 0.06) << "a few rows by view of floor and sky";
}

// A file under white light against path tracing of what its effects hold.
struct Checked {
    MeanSquares sum;
    double missing = 0;  // share of all light
};

Checked check_white(const formats::Scene& scene, const std::vector<std::string>& effects) {
    BakeOptions options = tests::only(effects);
    options.set(kStraightTerms, 9);
    const BakeResult baked = tests::bake_scene(scene, options);
    ModelProbes probes = choose_model_probes(scene, 96, 0, {}).value();
    probes.lights.resize(1);
    EXPECT_EQ(probes.lights[0].name, "white");
    ModelCheckOptions effort;
    effort.simulated = held_light(all_effects(), baked.plan);
    effort.noise = 0.02;
    effort.max_events = 1000000;
    LightCheck truth = trace_model_truth(scene, probes, effort, {}).value().front();
    const auto shown =
        relight_receivers(baked.asset.view(), probes.receivers,
                          {.vector = tests::make_light("white", baked.asset.view().cubemap_size)});
    for (std::size_t i = 0; i < shown.size(); ++i) {
        truth.pairs[i].difference = shown[i] - truth.pairs[i].truth;
    }
    const MeanSquares sum = sum_up(truth.pairs);
    return {sum, truth.missing / (truth.missing + sum.mean_truth / sum.count)};
}

// What bounces add to an absorbing ball, seen along its normals, and to its grey floor, on all
// paths.
TEST(SeenThrough, LightOfAFloorThatCrossesABallAgreesWithPathTracingAndNothingIsMissing) {
    const formats::Scene scene = ball_above_floor(0.3f, 0.6f, 1.3f);
    const Checked both = check_white(scene, kThrough), straight = check_white(scene, kStraight);
    const double traced = both.sum.mean_truth - straight.sum.mean_truth;
    const double added = traced + both.sum.mean_difference - straight.sum.mean_difference;
    std::printf("%.3f of the truth, which is %.3f of all light\n", added / traced,
                traced / both.sum.mean_truth);
    EXPECT_GT(traced, 0.1 * both.sum.mean_truth);
    EXPECT_NEAR(added / traced, 1, 0.12);
    EXPECT_LT(both.sum.rms_relative(), 0.1) << "few rows by view";
    EXPECT_LT(both.missing, 1e-6);
    // Of a file of bounces alone what crosses the ball is missing, whether it met the floor or not.
    EXPECT_GT(check_white(scene, kBetween).missing, straight.missing);
}

// What arrives from other surfaces and crosses is less than either effect may add.
TEST(SeenThrough, AddsLessThanTheBoundsOfBothEffectsAndSomething) {
    for (const float sigma_a : {0.01f, 0.3f}) {
        const formats::Scene scene = ball_above_floor(sigma_a, 0.8f, 1.3f);
        const BakeResult straight = tests::bake_scene(scene, tests::only(kStraight)),
                         both = tests::bake_scene(scene, tests::only(kThrough));
        const double bound = std::min(find_entry(both.plan, "transmission", 0)->bound,
                                      find_entry(both.plan, "interreflection", 0)->bound);
        const double added = tests::mean_green(tests::relight_primitive(both.asset, "white")) -
                             tests::mean_green(tests::relight_primitive(straight.asset, "white"));
        EXPECT_GT(added, 0.05 * bound) << sigma_a;
        EXPECT_LT(added, bound) << sigma_a;
    }
}

// Forcing what is left out of a body that lets hardly any light through.
TEST(SeenThrough, OfABodyTooDenseForItAddsLessThanTheBoundByWhichItIsLeftOut) {
    const formats::Scene scene = ball_above_floor(60, 0.8f, 1.3f);
    BakeOptions options = tests::only(kThrough);
    const BakeResult chosen = tests::bake_scene(scene, options);
    const PlanEntry& entry = *find_entry(chosen.plan, "transmission", 0);
    ASSERT_FALSE(entry.on);
    options.simulate_all = true;
    const BakeResult forced = tests::bake_scene(scene, options);
    ASSERT_TRUE(find_entry(forced.plan, "transmission", 0)->forced);
    const auto a = tests::relight_primitive(chosen.asset, "white"),
               b = tests::relight_primitive(forced.asset, "white");
    EXPECT_LE(std::abs(tests::mean_green(b) - tests::mean_green(a)), entry.bound);
}

// The check follows paths from the surfaces that views end on, the bake looks at clusters.
TEST(SeenThrough, ItsSelfCheckAgreesUnderEvenLight) {
    BakeOptions options = tests::only(kThrough);
    const BakeResult baked = tests::bake_scene(ball_above_floor(0.1f, 0.7f, 1.3f), options);
    ASSERT_EQ(baked.error.at_receivers.by_light[0].name, "white");
    EXPECT_LT(baked.error.at_receivers.by_light[0].rms_relative, 0.04);
}

}  // namespace
}  // namespace opaline::bake
