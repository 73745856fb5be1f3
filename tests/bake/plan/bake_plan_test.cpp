#include "bake/plan/bake_plan.h"

#include <gtest/gtest.h>

#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

TEST(BakePlan, ImpossibleKnobsAreUsageErrors) {
    for (const std::uint32_t size : {1u, 7u, 24u, 256u}) {
        BakeOptions options;
        options.cubemap_size = size;
        const auto knobs = resolve_knobs(options);
        ASSERT_FALSE(knobs) << size;
        EXPECT_EQ(knobs.error().kind, formats::ErrorKind::usage);
    }
    BakeOptions options;
    options.coefficients = 6;
    EXPECT_FALSE(resolve_knobs(options));
}

TEST(BakePlan, MoreCoefficientsThanTexelsMeansAll) {
    BakeOptions options;
    options.cubemap_size = 8;
    options.coefficients = 384;
    ASSERT_TRUE(resolve_knobs(options));
    EXPECT_EQ(resolve_knobs(options)->coefficients, kAllCoefficients);
}

TEST(BakePlan, BlackSurfacesAreNotSimulated) {
    auto scene = tests::make_scene({tests::make_sphere(1), tests::make_sphere(1)});
    scene.materials.push_back({.name = "Black", .base_color = {0, 0, 0}});
    scene.primitives[1].material = 1;
    const auto plan = plan_bake(scene, inspect_scene(scene), {});
    const PlanEntry* const grey = find_entry(plan, "direct", 0);
    const PlanEntry* const black = find_entry(plan, "direct", 1);
    ASSERT_TRUE(grey != nullptr && black != nullptr);
    EXPECT_TRUE(grey->on);
    EXPECT_FALSE(black->on);
    EXPECT_EQ(black->bound, 0);
    EXPECT_FALSE(find_entry(plan, "light.visibility", 1)->on) << "nobody would see it";
}

TEST(BakePlan, UnusedMaterialsAreNotMentioned) {
    auto scene = tests::make_scene({tests::make_sphere(1)});
    scene.materials.push_back({.name = "Unused"});
    for (const PlanEntry& entry : plan_bake(scene, inspect_scene(scene), {})) {
        EXPECT_EQ(entry.subject.index, 0u);
    }
}

TEST(BakePlan, EverythingForcedLeavesNothingOutForItsBound) {
    auto scene = tests::make_scene({tests::make_sphere(3), tests::make_sphere(1)});
    scene.materials.push_back({.name = "Ink"});
    formats::Medium& ink = scene.materials[1].medium.emplace();
    ink.sigma_s = {1e-3f, 1e-3f, 1e-3f};
    ink.sigma_a = {1e3f, 1e3f, 1e3f};
    ink.eta = 1;
    scene.primitives[1].material = 1;
    BakeOptions options;
    options.simulate_all = true;
    const SceneFacts facts = inspect_scene(scene);
    for (const auto& [effect, material] :
         {std::pair("multiple", 1u), {"single", 1u}, {"specular", 1u}}) {
        const auto chosen = plan_bake(scene, facts, {});
        const auto all = plan_bake(scene, facts, *resolve_knobs(options));
        const PlanEntry* const off = find_entry(chosen, effect, material);
        const PlanEntry* const on = find_entry(all, effect, material);
        EXPECT_FALSE(off->on || off->forced) << effect;
        EXPECT_TRUE(on->on && on->forced) << effect;
        EXPECT_EQ(on->bound, off->bound) << effect;
        EXPECT_NE(on->reason.find("forced"), std::string::npos) << on->reason;
    }
    // What is worth it anyway is not called forced.
    const auto all = plan_bake(scene, facts, *resolve_knobs(options));
    EXPECT_TRUE(find_entry(all, "direct", 0)->on);
    EXPECT_FALSE(find_entry(all, "direct", 0)->forced);
}

}  // namespace
}  // namespace opaline::bake
