// Views through clear bodies that touch, overlap and contain each other.

#include <array>
#include <cmath>

#include "bake/effects/transmission/straight_paths.h"
#include "bake/effects/transmission/view_fit.h"
#include "bake/physics/fresnel.h"
#include "tests/bake/transmission/straight_body.h"
#include "tests/support/touching_bodies.h"

namespace opaline::bake {
namespace {

using tests::make_box;
using tests::make_nested_scene;
using tests::make_smooth_glass;

constexpr glm::vec3 kAbove{0, 1, 0};
constexpr float kWide = 40;

tests::Primitive make_layer(float low, float high) {
    return make_box({-kWide, low, -kWide}, {kWide, high, kWide}, 1);
}

struct SlabLight {
    double passed = 0, returned = 0;
};

// Of light that arrives at a stack of layers from above, in the medium above: each layer joined to
// what lies below it, with all reflections between them (adding method). `index`: of the layers
// from above, the first and the last are half spaces. `sine`: outside, at index 1.
SlabLight add_layers(const std::vector<double>& index, double sine) {
    SlabLight below{1, 0};
    for (std::size_t i = index.size() - 1; i-- > 0;) {
        const double cosine = std::sqrt(1 - sine * sine / (index[i] * index[i]));
        const double f = fresnel_reflectance(cosine, index[i + 1] / index[i]);
        const double between = 1 / (1 - f * below.returned);
        below = {(1 - f) * below.passed * between,
                 f + (1 - f) * (1 - f) * below.returned * between};
    }
    return below;
}

// What views from the upper face of the first layer of `index` find below and above.
SlabLight look_through_layers(const tests::CrossedBody& crossed, double first, double sine) {
    const auto inside = static_cast<float>(sine / first);
    const glm::vec3 seen{inside, std::sqrt(1 - inside * inside), 0};
    // Little shares go on by chance.
    constexpr std::size_t kViews = 4096;
    const std::vector<glm::vec3> views(kViews, seen);
    const glm::vec3 from{0.1f, 2.999f, 0.2f};
    StraightLight light;
    follow_straight(crossed.body, tests::start_in(crossed, from, from), views, light);
    SlabLight found;
    for (const StraightExit& exit : light.exits) {
        EXPECT_NEAR(std::abs(exit.direction.x), sine, 1e-4);
        (exit.direction.y < 0 ? found.passed : found.returned) += double{exit.weight[0]} / kViews;
    }
    return found;
}

// Water between two panes of glass, whose faces lie on one another: inside of the uppermost face
// views find what passes the rest, and their own reflection at that face.
TEST(CrossedBodies, SlabsOnOneAnotherPassTheProductOfFresnelsTransmittancesWithAllReflections) {
    constexpr double kGlass = 1.5, kWater = 1.33;
    const auto crossed = tests::make_crossed_scene(
        make_nested_scene({{make_layer(2, 3), make_smooth_glass(kGlass)},
                           {make_layer(1, 2), make_smooth_glass(kWater)},
                           {make_layer(0, 1), make_smooth_glass(kGlass)}}),
        true);
    for (const double sine : {0.0, 0.6, 0.97}) {
        // Below the uppermost face, from within the first pane.
        const SlabLight rest = add_layers({kGlass, kWater, kGlass, 1}, sine);
        const double f = fresnel_reflectance(std::sqrt(1 - sine * sine / (kGlass * kGlass)),
                                             1 / kGlass),
                     between = 1 / (1 - f * rest.returned);
        const SlabLight found = look_through_layers(*crossed, kGlass, sine);
        EXPECT_NEAR(found.passed, rest.passed * between, 0.004) << sine;
        EXPECT_NEAR(found.returned, rest.returned * (1 - f) * between, 0.004) << sine;
        EXPECT_NEAR(found.passed + found.returned, 1, 0.003) << sine;
    }
}

// Where an interface reflects some 40 %, both ways are followed: one view is enough.
TEST(CrossedBodies, WhatIsReflectedBetweenUnlikeMediaIsFollowedApart) {
    constexpr double kGlass = 1.5, kGas = 1.05, kSine = 0.99;
    const auto crossed =
        tests::make_crossed_scene(make_nested_scene({{make_layer(2, 3), make_smooth_glass(kGlass)},
                                                     {make_layer(1, 2), make_smooth_glass(kGas)}}),
                                  true);
    const SlabLight rest = add_layers({kGlass, kGas, 1}, kSine);
    const double f = fresnel_reflectance(std::sqrt(1 - kSine * kSine / (kGlass * kGlass)),
                                         1 / kGlass),
                 between = 1 / (1 - f * rest.returned);
    ASSERT_GT(rest.returned, 0.2);
    const SlabLight found = look_through_layers(*crossed, kGlass, kSine);
    EXPECT_NEAR(found.passed, rest.passed * between, 0.01);
    EXPECT_NEAR(found.returned, rest.returned * (1 - f) * between, 0.01);
}

TEST(CrossedBodies, EachMediumAttenuatesItsOwnStretch) {
    formats::Medium above = make_smooth_glass(1), below = make_smooth_glass(1);
    above.sigma_a = {0.7f, 0.7f, 0.7f};
    below.sigma_s = {0.4f, 0.4f, 0.4f};  // what is scattered is the light of others
    const auto crossed = tests::make_crossed_scene(
        make_nested_scene({{make_layer(2, 3), above}, {make_layer(0, 2.5f), below}}), true);
    const auto exits =
        tests::look(*crossed, {0.1f, 2.999f, 0.2f}, glm::normalize(glm::vec3(3, 4, 0)));
    ASSERT_EQ(exits.size(), 1u);
    // The thinner of both fills where they overlap.
    EXPECT_NEAR(exits[0].weight[0], std::exp(-(0.7 * 0.999 + 0.4 * 2) / 0.8), 1e-4);
}

// By the order of media, from whichever of both a view comes.
TEST(CrossedBodies, BodiesOfOneIndexThatOverlapAreOneBody) {
    const formats::Medium glass = make_smooth_glass(1.5f);
    const auto both =
        tests::make_crossed_scene(make_nested_scene({{make_box({0, 0, 0}, {2, 1, 1}, 3), glass},
                                                     {make_box({1, 0, 0}, {3, 1, 1}, 4), glass}}),
                                  true);
    const auto one =
        tests::make_crossed_scene(make_nested_scene({{make_box({0, 0, 0}, {3, 1, 1}, 3), glass}}));
    const glm::vec3 from{0.4f, 0.9999f, 0.6f};
    for (const glm::vec3 seen : spread_views(kAbove, 1.5, 32, {0.5f, 0.3f}).seen) {
        const auto as_both = tests::look(*both, from, seen), as_one = tests::look(*one, from, seen);
        ASSERT_EQ(as_both.size(), as_one.size());
        for (std::size_t i = 0; i < as_one.size(); ++i) {
            EXPECT_NEAR(as_both[i].weight[0], as_one[i].weight[0], 1e-4f);
            EXPECT_NEAR(glm::distance(as_both[i].direction, as_one[i].direction), 0, 1e-3f);
        }
    }
}

TEST(CrossedBodies, ThatAbsorbNothingShowAnEvenSky) {
    const formats::Medium glass = make_smooth_glass(1.5f), water = make_smooth_glass(1.33f),
                          bubble = make_smooth_glass(1);
    const struct {
        const char* name;
        std::vector<tests::Part> parts;
        bool meets;
        glm::vec3 from, normal;
    } cases[] = {
        {"bubble in a ball",
         {{tests::make_sphere(4), glass}, {tests::make_sphere(4, 0.6f), bubble}},
         false,
         {0, 0.9999f, 0},
         kAbove},
        {"ball in a block",
         {{make_box({-1, -1, -1}, {1, 1, 1}, 2), water}, {tests::make_sphere(4, 0.7f), glass}},
         false,
         {0.1f, 0.9999f, 0.2f},
         kAbove},
        {"water in its glass",
         {{tests::make_cup(), glass}, {tests::make_drink(0), water}},
         true,
         {0.95f, 0.3f, 0.1f},
         {1, 0, 0}},
        {"water that reaches into its glass",
         {{tests::make_cup(), glass}, {tests::make_drink(-0.05f), water}},
         true,
         {0.9999f, 0.3f, 0.1f},
         {1, 0, 0}},
    };
    for (const auto& c : cases) {
        const auto crossed = tests::make_crossed_scene(make_nested_scene(c.parts), c.meets);
        const TransmissionViews views =
            spread_views(c.normal, crossed->body.eta, 256, {0.5f, 0.3f});
        StraightLight found;
        follow_straight(crossed->body, tests::start_in(*crossed, c.from, c.from), views.seen,
                        found);
        double sum = 0;
        for (const auto* exits : {&found.exits, &found.blocked}) {
            for (const StraightExit& exit : *exits) {
                sum += views.weight[exit.view] * double{exit.weight[0]};
            }
        }
        EXPECT_NEAR(sum, 1, 0.01) << c.name;
        EXPECT_LE(sum, 1.00001) << c.name;
    }
}

TEST(CrossedBodies, WhereWalksHoldWhatCrossesThemViewsEndAtOthers) {
    const auto crossed = tests::make_crossed_scene(
        make_nested_scene({{tests::make_sphere(4), make_smooth_glass(1.5f)},
                           {tests::make_sphere(4, 0.6f), make_smooth_glass(1.33f)}}));
    crossed->body.ends_at_others = true;
    StraightLight found;
    follow_straight(crossed->body, tests::start_in(*crossed, {0, 0.9999f, 0}, {}), {&kAbove, 1},
                    found);
    EXPECT_TRUE(found.exits.empty() && found.blocked.empty());
    EXPECT_EQ(found.inside.size(), 1u);
}

// Radiance over the squared index is what stays the same.
TEST(CrossedBodies, ALampInTwoMediaIsSeenOverTheSquareOfTheIndexThatIsAroundIt) {
    tests::Scene scene = make_nested_scene({{tests::make_sphere(4), make_smooth_glass(1.33f)},
                                            {tests::make_sphere(4, 0.6f), make_smooth_glass(1.5f)},
                                            {tests::make_sphere(3, 0.3f), {}}});
    scene.materials[2].medium.reset();
    const auto crossed = tests::make_crossed_scene(std::move(scene));
    StraightLight found;
    follow_straight(crossed->body, tests::start_in(*crossed, {0, 0.9999f, 0}, {}), {&kAbove, 1},
                    found);
    double sum = 0;
    for (const StraightExit& exit : found.inside) {
        sum += double{exit.weight[0]} / double{exit.eta * exit.eta};
    }
    // Of 1 less what the interface reflects, 0.4 % along the normal, by chance.
    EXPECT_NEAR(sum, 1 / (1.5 * 1.5), 1e-3);
}

// Total reflection by other than the smooth normal would keep some of it inside for good.
TEST(CrossedBodies, ManyInterfacesTakeBoundedWorkAndLoseLittle) {
    std::vector<tests::Part> parts;
    for (int i = 0; i < 11; ++i) {
        parts.emplace_back(tests::make_sphere(2, 1 - 0.08f * static_cast<float>(i)),
                           make_smooth_glass(i % 2 == 0 ? 1.5f : 1.0f));
    }
    const auto crossed = tests::make_crossed_scene(make_nested_scene(std::move(parts)));
    const glm::vec3 normal = crossed->scene.primitives[0].normal[17];
    const TransmissionViews views = spread_views(normal, 1.5, 64, {0.5f, 0.3f});
    StraightLight found;
    const std::uint64_t rays = follow_straight(
        crossed->body, tests::start_in(*crossed, 0.9999f * normal, {}), views.seen, found);
    double sum = 0;
    for (const auto* exits : {&found.exits, &found.blocked}) {
        for (const StraightExit& exit : *exits) {
            sum += views.weight[exit.view] * double{exit.weight[0]};
        }
    }
    EXPECT_LE(sum, 1.00001);
    EXPECT_GT(sum, 0.98);
    EXPECT_LT(rays, 64u * 500u);
}

}  // namespace
}  // namespace opaline::bake
