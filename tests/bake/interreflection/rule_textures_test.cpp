#include "bake/effects/interreflection/interreflection.h"

#include <gtest/gtest.h>

#include "bake/exchange/bounce_light.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/exchange/bounce_support.h"
#include "tests/bake/exchange/textured_plates.h"

namespace opaline::bake {
namespace {

const std::vector<std::string> kTexturedEffects{"direct", "interreflection"};

const PlanEntry* textures_of(std::span<const PlanEntry> plan) {
    return find_entry(plan, "interreflection.textures", 0);
}

PlanEntry decide_in(const formats::Scene& scene, bool all = false) {
    BakeOptions options =
        tests::bounce_options(all ? std::vector<std::string>{} : kTexturedEffects);
    options.simulate_all = all;
    const auto plan = plan_bake(scene, inspect_scene(scene), resolve_knobs(options).value());
    return *textures_of(plan);
}

// What filtering changes, of radiance under an even sky of radiance 1, at any vertex. Both plates
// have an albedo of 0.8 at most, where bounced light is seen.
double largest_change(const tests::BouncedIn& bounced) {
    const auto points = bounced.light(false), means = bounced.light(true);
    double most = 0;
    for (std::size_t v = 0; v < points.size(); ++v) {
        most = std::max(most, 0.8 * std::abs(points[v] - means[v]));
    }
    return most;
}

TEST(RuleTextures, ConcernsMaterialsWithTexturesWhereBouncedLightIsAskedFor) {
    formats::Scene scene = tests::make_textured_plates(tests::make_checker(64), 1);
    const auto plan_for = [&](std::vector<std::string> effects) {
        const Knobs knobs = resolve_knobs(tests::bounce_options(std::move(effects))).value();
        return plan_bake(scene, inspect_scene(scene), knobs);
    };
    EXPECT_TRUE(textures_of(plan_for(kTexturedEffects))->on);
    EXPECT_EQ(textures_of(plan_for({"direct"})), nullptr);
    EXPECT_TRUE(textures_of(plan_for({}))->on);
    scene.primitives[0].texcoord.clear();
    EXPECT_EQ(textures_of(plan_for(kTexturedEffects)), nullptr);
}

TEST(RuleTextures, IsOffWhereNothingCouldChange) {
    using tests::make_textured_plates;
    EXPECT_GT(decide_in(make_textured_plates(tests::make_checker(64), 1)).bound, 0.1);
    const PlanEntry even = decide_in(make_textured_plates(tests::make_even_texels(64, 100), 1));
    EXPECT_FALSE(even.on);
    EXPECT_EQ(even.bound, 0);
    const PlanEntry faint = decide_in(make_textured_plates(tests::make_checker(64, 100, 101), 1));
    EXPECT_FALSE(faint.on);
    EXPECT_GT(faint.bound, 0);
    EXPECT_FALSE(decide_in(make_textured_plates(tests::make_checker(2), 0.5f)).on) << "magnified";
    formats::Scene ball = tests::make_scene({tests::make_sphere(2)});
    ball.images.push_back(tests::make_checker(64));
    ball.materials[0].base_color_image = 0;
    for (const glm::vec3& p : ball.primitives[0].position) {
        ball.primitives[0].texcoord.emplace_back(p.x, p.y);
    }
    EXPECT_FALSE(decide_in(ball).on) << "nothing sees a lone convex body";
    ball.materials[0].double_sided = true;
    EXPECT_TRUE(decide_in(ball).on) << "its inside is not known";
}

// Where the bound leaves it out, forcing it changes no more than the bound: not a bit where texels
// are wider than the cells that are averaged over, or all the same.
TEST(RuleTextures, WhatItLeavesOutChangesNoMoreThanItsBound) {
    for (const formats::Image8& image : {tests::make_checker(64, 100, 101), tests::make_checker(2),
                                         tests::make_even_texels(64, 100)}) {
        const tests::BouncedIn bounced(tests::make_textured_plates(image, 0.5f));
        const PlanEntry off = decide_in(bounced.scene);
        ASSERT_FALSE(off.on);
        EXPECT_TRUE(decide_in(bounced.scene, true).forced);
        EXPECT_LE(largest_change(bounced), off.bound);
    }
}

// A checker of black and white: filtering changes what points of it would send by more than is left
// out, and by less than the bound.
TEST(RuleTextures, WhatItTurnsOnMattersAndStaysBelowItsBound) {
    const tests::BouncedIn bounced(tests::make_textured_plates(tests::make_checker(64), 1));
    const PlanEntry on = decide_in(bounced.scene);
    ASSERT_TRUE(on.on);
    const double change = largest_change(bounced);
    EXPECT_GT(change, kLeastBound);
    EXPECT_LT(change, on.bound);
}

}  // namespace
}  // namespace opaline::bake
