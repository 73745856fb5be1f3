#include "bake/effects/incident/incident.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/plan/row_layout.h"
#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

struct Decision {
    PlanEntry colour;
    RowLayout layout;
};

Decision decide(const formats::Medium& medium, const Knobs& knobs = {}) {
    const auto scene = tests::make_translucent_scene({tests::make_sphere(2)}, medium);
    const auto plan = plan_bake(scene, inspect_scene(scene), knobs);
    return {*find_entry(plan, "light.colour", 0), layout_rows(scene, plan, knobs)[0]};
}

TEST(RuleColour, EqualBandsNeedOneAndNothingIsLost) {
    const Decision decision = decide(tests::make_grey_medium(10, 0.2f));
    EXPECT_FALSE(decision.colour.on);
    EXPECT_EQ(decision.colour.bound, 0);
    EXPECT_EQ(decision.layout.bands(), 1u);
}

TEST(RuleColour, BandsThatDifferByOneBitAreKept) {
    for (const bool is_scattering : {false, true}) {
        formats::Medium medium = tests::make_grey_medium(10, 0.2f);
        float& blue = is_scattering ? medium.sigma_s.b : medium.sigma_a.b;
        blue = std::nextafter(blue, 100.0f);
        const Decision decision = decide(medium);
        EXPECT_TRUE(decision.colour.on);
        EXPECT_FALSE(decision.colour.forced);
        EXPECT_GT(decision.colour.bound, 0);
        EXPECT_EQ(decision.layout.bands(), 3u);
    }
}

TEST(RuleColour, AllEffectsForceThreeBands) {
    Knobs knobs;
    knobs.simulate_all = true;
    const Decision decision = decide(tests::make_grey_medium(10, 0.2f), knobs);
    EXPECT_TRUE(decision.colour.on && decision.colour.forced);
    EXPECT_EQ(decision.layout.bands(), 3u);
}

// Of a medium of which nothing is simulated, rows are zero in every band.
TEST(RuleColour, WhatIsNotSimulatedHasNoColour) {
    formats::Medium medium = tests::make_grey_medium(10, 0.2f);
    medium.sigma_a.b = 5;
    EXPECT_EQ(decide(medium).layout.bands(), 3u);
    Knobs knobs;
    knobs.effects = {"specular"};
    const Decision decision = decide(medium, knobs);
    EXPECT_FALSE(decision.colour.on);
    EXPECT_EQ(decision.colour.bound, 0);
    EXPECT_EQ(decision.layout.bands(), 1u);
}

}  // namespace
}  // namespace opaline::bake
