#include "bake/emitters/plan_emitters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/emitters/describe_emitters.h"
#include "bake/emitters/emitter_knobs.h"
#include "tests/bake/emitters/lamp_scenes.h"

namespace opaline::bake {
namespace {

TEST(PlanEmitters, IsEmptyWhereNothingSendsOutLight) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.5f);
    scene.lights.push_back({.name = "", .intensity = {0, 0, 0}});
    const EmitterPlan plan = plan_emitters(scene, {});
    EXPECT_TRUE(plan.entries.empty() && plan.lamps.empty());
}

TEST(PlanEmitters, EveryLampIsOnUnlessItIsLeftOut) {
    const formats::Scene scene = tests::parallel_squares();
    const EmitterPlan plan = plan_emitters(scene, {});
    ASSERT_EQ(plan.entries.size(), 1u);
    EXPECT_TRUE(plan.entries[0].on);
    EXPECT_TRUE(std::isnan(plan.entries[0].bound));
    EXPECT_EQ(plan.entries[0].subject.name, "emitter 'quad'");
    EXPECT_EQ(plan.lamps.size(), 1u);
    EXPECT_TRUE(emitter_knobs::is_lit({}, plan.entries));
    Knobs knobs;
    knobs.effects = {"direct"};
    const EmitterPlan without = plan_emitters(scene, knobs);
    EXPECT_FALSE(without.entries[0].on);
    EXPECT_TRUE(without.lamps.empty());
    EXPECT_FALSE(emitter_knobs::is_lit({}, without.entries));
}

TEST(PlanEmitters, LightsWithoutAnySurfaceAreOff) {
    formats::Scene scene;
    scene.lights.push_back({.name = "Bulb"});
    const EmitterPlan plan = plan_emitters(scene, {});
    ASSERT_EQ(plan.entries.size(), 1u);
    EXPECT_FALSE(plan.entries[0].on);
    EXPECT_EQ(plan.entries[0].bound, 0);
}

TEST(PlanEmitters, QualitiesHaveEverMoreRaysAndParticles) {
    const EffectDescriptor effect = describe_emitters(Effect{});
    EXPECT_EQ(effect.name, "emitters");
    for (const KnobSpec* knob : effect.knobs) {
        EXPECT_LT(knob->preset[0], knob->preset[1]);
        EXPECT_LT(knob->preset[2], knob->preset[3]);
        EXPECT_LT(knob->for_target(0.2), knob->for_target(0.001));
    }
}

}  // namespace
}  // namespace opaline::bake
