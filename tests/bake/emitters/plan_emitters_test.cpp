#include "bake/effects/emitters/plan_emitters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/effects/effects.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/support/volumes.h"

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

TEST(PlanEmitters, AFlameLightsSurfacesUnlessTheyAreTooFar) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), 0.5f);
    formats::Volume flame = tests::make_volume(tests::make_blob(0.1, 0.05), 1, 0, 0);
    flame.sigma_t = {1e-3f, 1e-3f, 1e-3f};
    tests::make_it_glow(flame, glm::vec3(1e3f));
    flame.emitter = "quad";
    scene.volumes = {flame};
    const auto plan_at = [&](double height) {
        scene.volumes[0].density.to_scene[3] = glm::dvec4(0, height, 0, 1);
        return plan_emitters(scene, {});
    };
    const EmitterPlan near = plan_at(1);
    ASSERT_EQ(near.lamps.size(), 1u);
    EXPECT_EQ(near.lamps[0].volume, 0u);
    EXPECT_TRUE(near.entries[0].on);
    // Twice the light of a point of its power, as half of it is reflected again and again.
    const double power = 1e3 * 1e-3 * std::pow(2 * std::numbers::pi, 1.5) * 1e-3;
    const double far = 10.5;
    EXPECT_NEAR(plan_at(far).entries[0].bound,
                2 * power / (std::numbers::pi * std::pow(far - 0.45, 2)), 0.03 * power / 100);
    EXPECT_FALSE(plan_at(100).entries[0].on);
    // Smoke may send light there that would not come by itself.
    formats::Volume smoke = tests::make_volume(tests::make_blob(0.5, 0.25), 3, 0.9f, 0);
    smoke.emission = {};
    scene.volumes.push_back(smoke);
    EXPECT_TRUE(plan_at(100).entries[0].on);
    scene.primitives.clear();
    EXPECT_FALSE(plan_at(1).entries[0].on);
}

TEST(PlanEmitters, QualitiesHaveEverMoreRaysAndParticles) {
    const EffectDescriptor effect = all_effects()[Effect::emitters];
    EXPECT_EQ(effect.name, "emitters");
    for (const KnobSpec* knob : effect.knobs) {
        EXPECT_LT(knob->preset[0], knob->preset[1]);
        EXPECT_LT(knob->preset[2], knob->preset[3]);
        EXPECT_LT(knob->for_target(0.2), knob->for_target(0.001));
    }
}

}  // namespace
}  // namespace opaline::bake
