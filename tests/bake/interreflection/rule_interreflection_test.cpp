#include <gtest/gtest.h>

#include "bake/effects/interreflection/interreflection.h"
#include "bake/exchange/bounce_light.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/exchange/bounce_support.h"
#include "tests/bake/exchange/textured_plates.h"

namespace opaline::bake {
namespace {

const std::vector<std::string> kRuleEffects{"direct", "interreflection"};

bool is_on(const formats::Scene& scene, std::uint32_t material = 0) {
    const Knobs knobs = resolve_knobs(tests::bounce_options(kRuleEffects)).value();
    const auto plan = plan_bake(scene, inspect_scene(scene), knobs);
    return find_entry(plan, "interreflection", material)->on;
}

TEST(RuleInterreflection, ALoneConvexBodyHasNoneAndABodyOnAFloorHas) {
    EXPECT_FALSE(is_on(tests::make_scene({tests::make_sphere(2)})));
    EXPECT_TRUE(is_on(tests::make_dented_ball()));
}

TEST(RuleInterreflection, ActsUnlessAListLeavesItOut) {
    const formats::Scene scene = tests::make_dented_ball();
    const auto decided = [&](std::vector<std::string> effects, bool all) {
        BakeOptions options = tests::bounce_options(std::move(effects));
        options.simulate_all = all;
        const auto plan = plan_bake(scene, inspect_scene(scene), resolve_knobs(options).value());
        return find_entry(plan, "interreflection", 0)->on;
    };
    EXPECT_TRUE(decided({}, false)) << "auto";
    EXPECT_TRUE(decided({}, true)) << "all";
    EXPECT_FALSE(decided({"direct"}, true));
    EXPECT_FALSE(decided({"direct"}, false));
    EXPECT_TRUE(decided(kRuleEffects, false));
}

TEST(RuleInterreflection, BlackSurfacesReflectNothingToOthers) {
    EXPECT_TRUE(is_on(tests::make_plates(1, 0.5f, 1)));
    EXPECT_FALSE(is_on(tests::make_plates(1, 0.02f, 1)));
}

// Where it is on, what it adds to the first plate is below its bound: o rho rho_max.
void expect_less_than_bound(const formats::Scene& scene, std::vector<std::string> effects) {
    const auto without = tests::bake_scene(scene, tests::bounce_options(effects));
    effects.emplace_back("interreflection");
    const auto with = tests::bake_scene(scene, tests::bounce_options(effects));
    const PlanEntry& entry = *find_entry(with.plan, "interreflection", 0);
    ASSERT_TRUE(entry.on);
    const auto a = tests::relight(without.asset.view(), "white");
    const auto b = tests::relight(with.asset.view(), "white");
    double most = 0;
    for (std::size_t v = 0; v < scene.primitives[0].position.size(); ++v) {
        most = std::max(most, static_cast<double>(b[v].g - a[v].g));
    }
    EXPECT_GT(most, 0.1 * entry.bound);
    EXPECT_LT(most, entry.bound);
}

TEST(RuleInterreflection, AddsLessThanItsBound) {
    expect_less_than_bound(tests::make_plates(0.5f, 0.6f, 4), {"direct"});
}

// The floor is too dark to light itself; the metal above it sends what it mirrors.
TEST(RuleInterreflection, AMetalLightsADarkFloorAndStaysBelowItsBound) {
    formats::Scene scene = tests::make_plates(0.5f, 0.04f, 4);
    scene.materials[1].base_color = {0.95f, 0.95f, 0.95f};
    scene.materials[1].gloss.metallic = 1;
    scene.materials[1].gloss.roughness = 0.5f;
    expect_less_than_bound(scene, {"direct", "gloss"});
}

// A boundary mirrors light that grazes it, however black what it bounds.
TEST(RuleInterreflection, ABlackMediumLightsAFloorAndOneOfIndexOneDoesNot) {
    formats::Scene scene = tests::make_plates(0.5f, 0.02f, 4);
    EXPECT_FALSE(is_on(scene));
    scene.materials[1].medium = formats::Medium{};
    scene.materials[1].medium->eta = 1.5f;
    EXPECT_TRUE(is_on(scene));
    scene.materials[1].medium->eta = 1;
    EXPECT_FALSE(is_on(scene));
}

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
