#include <gtest/gtest.h>

#include <string>

#include "bake/effects/volumes/plan_volumes.h"
#include "bake/pipeline/cost_model.h"
#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

// The stages that a bake reports are those that were predicted, in the same order.
void expect_stages_as_predicted(const Scene& scene, const bake::BakeOptions& options) {
    const bake::BakeResult result = bake_scene(scene, options);
    const bake::Knobs knobs = *bake::resolve_knobs(options);
    const bake::SceneFacts facts = bake::inspect_scene(scene);
    auto plan = bake::plan_bake(scene, facts, knobs);
    const bake::CostPrediction cost =
        bake::predict_costs(scene, facts, knobs, {}, result.threads, plan);
    std::vector<std::string> predicted, reported;
    for (const bake::StageCost& stage : cost.stages) {
        predicted.push_back(stage.name);
    }
    for (const bake::StageReport& stage : result.stages) {
        reported.push_back(stage.name);
    }
    EXPECT_EQ(predicted, reported);
    EXPECT_EQ(cost.receivers, result.asset.position.size());
}

formats::Medium forward_medium() {
    formats::Medium medium = make_grey_medium(10, 1);
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = 0.5f;
    return medium;
}

TEST(Prediction, EveryKindOfSceneHasTheStagesThatWerePredicted) {
    const formats::Medium grey = make_grey_medium(10, 1);
    const Scene dense = make_translucent_scene({make_sphere(5)}, make_grey_medium(2e4f, 4e3f));
    const Scene matched = make_ball_on_floor(make_grey_medium(10, 1, 1.0f));
    Scene textured = make_dented_ball();  // bounced light is filtered by textures
    textured.images.push_back({2, 1, {0, 0, 0, 255, 255, 255, 255, 255}});
    textured.materials[0].base_color_image = 0;
    for (const glm::vec3& p : textured.primitives[1].position) {
        textured.primitives[1].texcoord.emplace_back(9 * p.x, p.z);
    }
    Scene smoke, smoke_on_floor, shadow;
    smoke.materials.resize(1);
    smoke.volumes.push_back(make_volume(make_blob(0.5, 0.25), 2, 0.9f, 0));
    smoke_on_floor = smoke;
    smoke_on_floor.primitives.push_back(make_quad({-3, -1.02f, -3}, {0, 0, 6}, {6, 0, 0}, 4));
    shadow = smoke_on_floor;
    shadow.volumes[0].albedo = {0, 0, 0};  // nothing to check
    bake::BakeOptions four_terms = small_bake(), pilot = small_bake();
    four_terms.set(bake::kPhaseTerms, 4);
    pilot.error = 0.5;  // the first choice will do
    const struct {
        const char* name;
        Scene scene;
        bake::BakeOptions options = small_bake();
    } cases[] = {{"opaque", make_dented_ball()},
                 {"convex", make_scene({make_sphere(4)})},
                 {"dense", dense},
                 {"medium on a floor", make_ball_on_floor(grey)},
                 {"scatters forward", make_ball_on_floor(forward_medium()), four_terms},
                 {"multiple alone", matched, only({"multiple"})},
                 {"single alone", matched, only({"single"})},
                 {"direct alone", matched, only({"direct"})},
                 {"textures", textured, only({"direct", "interreflection"})},
                 {"textures without bounces", textured, only({"direct"})},
                 {"pilot", make_ball_on_floor(grey), pilot},
                 {"volume", smoke},
                 {"volume above a floor", smoke_on_floor},
                 {"black volume above a floor", shadow}};
    for (const auto& [name, scene, options] : cases) {
        SCOPED_TRACE(name);
        expect_stages_as_predicted(scene, options);
    }
}

TEST(Prediction, RefinementIsAStageOfTheRaysThatItTraced) {
    bake::BakeOptions options = small_bake();
    options.refine.mode = bake::RefineChoice::Mode::where_light_changes;
    const Scene scene = make_scene(
        {make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), make_sphere(3, 0.3f, {0.3f, 0.4f, 0.2f})});
    const bake::BakeResult result = bake_scene(scene, options);
    ASSERT_TRUE(result.scene);
    const bake::Knobs knobs = *bake::resolve_knobs(options);
    std::vector<bake::PlanEntry> plan = result.plan;
    const bake::CostPrediction cost =
        bake::predict_costs({.effects = bake::all_effects(),
                             .scene = *result.scene,
                             .facts = result.facts,
                             .knobs = knobs,
                             .rates = bake::StageRates{},
                             .threads = 1,
                             .refinement_rays = result.refinement.rays},
                            plan);
    std::vector<std::string> predicted, reported;
    for (const bake::StageCost& stage : cost.stages) {
        predicted.push_back(stage.name);
        EXPECT_TRUE(stage.name != "refinement" || stage.work > 0);
    }
    for (const bake::StageReport& stage : result.stages) {
        reported.push_back(stage.name);
    }
    EXPECT_EQ(predicted, reported);
    EXPECT_EQ(std::ranges::count(reported, "refinement"), 1);
}

TEST(Prediction, SecondsAndBytesOfVolumesBelongToTheirDecisions) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(make_volume(make_blob(0.5, 0.25), 4, 0.9f, 0.5f));
    const bake::Knobs knobs = *bake::resolve_knobs(small_bake());
    const bake::SceneFacts facts = bake::inspect_scene(scene);
    std::vector<bake::PlanEntry> volumes = bake::plan_volumes(scene, knobs).entries;
    const bake::StageRates rates{};
    const bake::CostPrediction cost =
        bake::predict_costs({bake::all_effects(), scene, facts, knobs, rates, 2}, volumes);
    double seconds = cost.shared_seconds;
    std::uint64_t bytes = cost.shared_bytes;
    for (const bake::PlanEntry& entry : volumes) {
        EXPECT_GT(entry.predicted_seconds, 0) << entry.name;
        seconds += entry.predicted_seconds;
        bytes += entry.predicted_bytes;
    }
    EXPECT_NEAR(seconds, cost.seconds, 1e-9 * cost.seconds);
    EXPECT_EQ(bytes, cost.bytes);
    const bake::BakeResult result = bake_scene(scene, small_bake());
    const auto& rows = result.asset.volumes.rows;
    const double stored =
        4.0 * static_cast<double>(rows.row_offset.size()) +
        4.0 * static_cast<double>(rows.average_scale.size() + rows.detail_scale.size()) +
        2.0 * static_cast<double>(rows.average_code.size() + rows.index16.size()) +
        static_cast<double>(rows.code8.size());
    const auto predicted =
        static_cast<double>(volumes[0].predicted_bytes + volumes[1].predicted_bytes);
    EXPECT_GT(predicted, 0.99 * stored);
    EXPECT_LT(predicted, 2 * stored);
}

TEST(Prediction, BytesAreThoseOfTheRowsInTheFile) {
    bake::BakeOptions options = small_bake();
    options.coefficients = 64;
    const Scene scene = make_ball_on_floor(make_grey_medium(10, 1));
    const bake::Knobs knobs = *bake::resolve_knobs(options);
    const bake::SceneFacts facts = bake::inspect_scene(scene);
    auto plan = bake::plan_bake(scene, facts, knobs);
    bake::predict_costs(scene, facts, knobs, {}, 1, plan);
    double predicted = 0;
    for (const bake::PlanEntry& entry : plan) {
        predicted += static_cast<double>(entry.predicted_bytes);
    }
    const formats::SparseRows& rows = bake_scene(scene, options).asset.transport;
    const std::size_t bytes =
        4 * rows.row_offset.size() + 4 * (rows.average_scale.size() + rows.detail_scale.size()) +
        2 * rows.average_code.size() + 2 * rows.index16.size() + rows.code8.size();
    EXPECT_NEAR(predicted, static_cast<double>(bytes), 0.05 * static_cast<double>(bytes));
}

TEST(Prediction, ErrorsByReceiverTakeTheBytesOfTheirSectionAndNoTime) {
    const Scene scene = make_dented_ball();
    const bake::Knobs knobs = *bake::resolve_knobs(small_bake());
    const bake::SceneFacts facts = bake::inspect_scene(scene);
    const bake::StageRates rates{};
    auto plan = bake::plan_bake(scene, facts, knobs);
    bake::CostRequest request{bake::all_effects(), scene, facts, knobs, rates, 1};
    const bake::CostPrediction without = bake::predict_costs(request, plan);
    request.receiver_errors = true;
    const bake::CostPrediction with = bake::predict_costs(request, plan);
    // u32 receivers, 12 bytes 0, then a float each (formats/README.md, RERR).
    std::uint64_t section = 16;
    for (const formats::Primitive& primitive : scene.primitives) {
        section += 4 * primitive.position.size();
    }
    EXPECT_EQ(with.bytes - without.bytes, section);
    EXPECT_EQ(with.shared_bytes - without.shared_bytes, section);
    EXPECT_EQ(with.seconds, without.seconds);
}

}  // namespace
}  // namespace opaline::tests
