#include "bake/effects/rows/gather_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/effects/rows/medium_rows.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/exchange/other_light.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/bake/single/single_support.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

// A user who asks for few walks gets no more of them on the way; one who asks for many waits for
// few in each step.
TEST(CoarseKnobs, TakeNoMoreThanTheFileAndNoMoreThanAStepNeeds) {
    const auto coarse = [](double walks, double epsilon) {
        BakeOptions options;
        options.quality = Quality::production;
        options.set(kWalks, walks);
        options.set(kEpsilon, epsilon);
        return coarse_knobs(all_effects(), resolve_knobs(options).value(), 8);
    };
    EXPECT_EQ(coarse(20000, 1e-3)[kWalks], 20000);
    EXPECT_EQ(coarse(5e6, 1e-3)[kWalks], kWalks.coarse);
    EXPECT_EQ(coarse(5e6, 1e-5)[kEpsilon], kEpsilon.preset.front());
    EXPECT_EQ(coarse(5e6, 1e-3).cubemap_size, 8u);
}

// Light in the place of the environment, by columns that stand for anything: a medium's answer is
// linear in it. What is left of the subject is its study.
TEST(RowsOfPoints, AreLinearInLightThatReplacesTheEnvironment) {
    const auto setup = tests::set_up(
        tests::make_translucent_scene({tests::make_sphere(2)}, tests::make_grey_medium(6, 0.3f)),
        4);
    Knobs knobs;
    knobs.cubemap_size = 1;
    knobs.effects = {"multiple"};
    knobs.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
    knobs.set(kSamples, 500);
    const SceneFacts facts = inspect_scene(setup.scene);
    const std::vector<ReceiverSet> sets = tests::receivers_of(setup);
    const auto sky = RayScene::build({}, 1);
    formats::Scene lamps = setup.scene;
    lamps.lights = {{.name = "red", .intensity = {1, 0, 0}, .position = {0, 0, 5}},
                    {.name = "green", .intensity = {2, 4, 0}, .position = {0, 0, 5}}};
    const auto sources = tests::all_sources(lamps);
    const LampLight straight{lamps, setup.rays, sources, 16};
    const LampBounces alone{straight};
    const OtherLight light{.lamps = &alone, .environment = false};
    BakeInputs bake{all_effects(), setup.scene, facts, setup.rays, *sky, sets, &light};
    const std::vector<PlanEntry> plan = plan_bake(setup.scene, facts, knobs);
    std::vector<SubjectState> subjects = begin_subjects(bake, plan, knobs);
    subjects[0].layout.coloured = true;
    StageLog log;
    const Context context;
    run_step(Step::study, bake, knobs, context, subjects, log);
    std::uint64_t rays = 0;
    const auto rows =
        rows_of_points(bake, knobs, context, subjects[0], std::span(sets[0].outside).first(9),
                       std::span(sets[0].inside).first(9), rays);
    ASSERT_EQ(rows.size(), 9u);
    EXPECT_GT(rays, 0u);
    for (const std::vector<float>& row : rows) {
        ASSERT_EQ(row.size(), subjects[0].layout.terms() * 3 * 6u);
        EXPECT_GT(row[0], 0);
        EXPECT_NEAR(row[1], 2 * row[0], 1e-4f * row[0]);
        EXPECT_NEAR(row[6 + 1], 4 * row[0], 1e-3f * row[0]) << "the medium is grey";
        EXPECT_EQ(row[2], 0);
        EXPECT_EQ(row[6], 0);
    }
    EXPECT_TRUE(std::ranges::all_of(subjects[0].effects, [](const EffectState& effect) {
        return effect.samples == nullptr && effect.prepared == nullptr;
    }));
    EXPECT_TRUE(std::ranges::any_of(
        subjects[0].effects, [](const EffectState& effect) { return effect.study != nullptr; }));
}

}  // namespace
}  // namespace opaline::bake
