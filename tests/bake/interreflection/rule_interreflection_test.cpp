#include "bake/effects/interreflection/interreflection.h"

#include <gtest/gtest.h>

#include "bake/scene/inspect_scene.h"
#include "tests/bake/exchange/bounce_support.h"

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

}  // namespace
}  // namespace opaline::bake
