#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bake/effects/layers/layer_knobs.h"
#include "bake/pipeline/cost_model.h"
#include "bake/pipeline/unmet_requests.h"
#include "bake/scene/inspect_scene.h"
#include "formats/opal/check_clouds.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/write_opal.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/see_layer.h"
#include "tests/support/media_bake.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

using formats::Rgb;
using ::testing::HasSubstr;

formats::CloudLayer make_layer() {
    formats::CloudLayer layer;
    layer.name = "layer 1";
    layer.columns = layer.rows = 2;
    layer.thickness = {0, 50, 100, 150};
    layer.effective_radius = 3e-6;
    layer.ground_albedo = {{90, 100, 80, 255}};
    return layer;
}

Scene make_layer_scene() {
    Scene scene;
    scene.materials.resize(1);
    scene.layers.push_back(make_layer());
    return scene;
}

bake::BakeOptions layer_bake() {
    bake::BakeOptions options = small_bake();
    options.set(bake::kCloudNodes, 8);
    options.set(bake::kCloudStep, 1);
    return options;
}

TEST(CloudBake, LayerAloneMakesALegalFileThatStatesItsError) {
    bake::BakeOptions options = small_bake();
    options.quality = bake::Quality::draft;
    const bake::BakeResult result = bake_scene(make_layer_scene(), options);
    EXPECT_TRUE(result.warnings.empty());
    ASSERT_EQ(result.asset.clouds.records.size(), 1u);
    const TemporaryFolder folder;
    auto output = formats::AtomicFile::create(folder / "a.opal");
    ASSERT_TRUE(output);
    ASSERT_TRUE(formats::write_opal(result.asset.view(), std::move(*output)));
    const auto bytes = formats::FileBytes::open(folder / "a.opal");
    ASSERT_TRUE(bytes);
    const auto file = formats::read_opal(bytes->bytes(), "a.opal", formats::Checks::full);
    ASSERT_TRUE(file);

    ASSERT_TRUE(result.layer_error);
    EXPECT_GT(result.layer_error->rms_relative, 0);
    EXPECT_LT(result.layer_error->rms_relative, 0.05);
    const auto json = nlohmann::json::parse(result.asset.provenance);
    EXPECT_EQ(json.at("error").at("rms_relative"), result.layer_error->rms_relative);
    EXPECT_EQ(json.at("error").at("by_effect").at("cloud"), result.layer_error->rms_relative);
    EXPECT_EQ(json.at("layer_error").at("tables"), result.layer_error->tables);
    EXPECT_EQ(json.at("layers").at(0).at("bands").size(), 3u);
    EXPECT_EQ(json.at("knobs").at("cloud_nodes"), 12);
    std::vector<std::string> effects;
    for (const auto& entry : json.at("plan")) {
        effects.push_back(entry.at("effect"));
        EXPECT_EQ(entry.at("decision"), "on");
        EXPECT_EQ(entry.at("subject"), "layer 1");
    }
    EXPECT_THAT(effects, ::testing::ElementsAre("cloud", "cloud.multiple", "radiosity"));
}

TEST(CloudBake, LayerStandsBesideMeshesAndVolumes) {
    Scene scene = make_scene({make_sphere(1)});
    scene.volumes.push_back(make_volume(make_blob(0.5, 0.25), 4, 0.9f, 0.3f));
    scene.layers.push_back(make_layer());
    const bake::BakeResult result = bake_scene(scene, layer_bake());
    EXPECT_FALSE(result.asset.position.empty());
    EXPECT_FALSE(result.asset.volumes.records.empty());
    EXPECT_EQ(result.asset.clouds.records.size(), 1u);
    EXPECT_GT(result.error.receivers_checked, 0u);
    EXPECT_EQ(result.error.by_effect.back().name, "cloud");
    EXPECT_NE(result.error.rms_relative, result.layer_error->rms_relative);
    EXPECT_EQ(formats::find_clouds_fault(result.asset.clouds.view()).what, "");
}

// Under a white sky; from below, from above, and level, upward and downward.
std::vector<Rgb> look_around(const formats::Asset& asset) {
    formats::Environment white;
    white.width = 16;
    white.height = 8;
    white.pixel.assign(16 * 8, {1, 1, 1});
    const auto light = runtime::light_layers(asset.clouds.view(), white, {}, {.threads = 1});
    std::vector<Rgb> seen;
    for (const float eye : {2.0f, 3000.0f}) {
        for (const float up : {0.9f, 0.1f, -0.1f, -0.9f}) {
            runtime::LayerRay ray;
            ray.origin = {10, eye, 20};
            ray.direction = {std::sqrt(1 - up * up), up, 0};
            seen.push_back(see_through_layer({light, white, {}}, ray));
        }
    }
    return seen;
}

TEST(CloudBake, LayerThatIsNotSeenLeavesItsGround) {
    Scene scene = make_layer_scene();
    bake::BakeOptions options = layer_bake();
    for (const float thickness : {0.0f, 1e-4f}) {
        scene.layers[0].thickness.assign(4, thickness);
        const bake::BakeResult left_out = bake_scene(scene, options);
        ASSERT_EQ(left_out.asset.clouds.records.size(), 1u);
        EXPECT_EQ(left_out.asset.clouds.records[0].highest, 0);
        EXPECT_EQ(formats::find_clouds_fault(left_out.asset.clouds.view()).what, "");
        EXPECT_FALSE(left_out.layer_error);
        const std::vector<Rgb> seen = look_around(left_out.asset);
        // The ground is of the code 100, an albedo of 0.127.
        EXPECT_NEAR(seen[3].g, 0.127f, 1e-3f);
        EXPECT_NEAR(seen[0].g, 1, 1e-5f);
        if (thickness == 0) continue;
        options.simulate_all = true;
        const bake::BakeResult forced = bake_scene(scene, options);
        EXPECT_GT(forced.asset.clouds.records[0].highest, 0);
        const std::vector<Rgb> truth = look_around(forced.asset);
        const double bound = left_out.plan[0].bound;
        EXPECT_EQ(left_out.plan[0].name, "cloud");
        for (std::size_t i = 0; i < seen.size(); ++i) {
            EXPECT_NEAR(seen[i].r, truth[i].r, bound) << i;
            EXPECT_NEAR(seen[i].b, truth[i].b, bound) << i;
        }
    }
}

TEST(CloudBake, EffectsWithoutTheCloudLeaveTheGround) {
    bake::BakeOptions options = layer_bake();
    options.effects = {"direct"};
    const bake::BakeResult result = bake_scene(make_layer_scene(), options);
    ASSERT_EQ(result.asset.clouds.records.size(), 1u);
    EXPECT_EQ(result.asset.clouds.records[0].highest, 0);
    EXPECT_FALSE(result.asset.clouds.records[0].has_radiosity());
}

TEST(CloudBake, TargetErrorChoosesTheTables) {
    bake::BakeOptions options = small_bake();
    options.error = 0.05;
    const bake::BakeResult result = bake_scene(make_layer_scene(), options);
    EXPECT_EQ(result.knobs[bake::kCloudNodes], bake::layer_knobs::nodes_for(0.05));
    EXPECT_LE(result.layer_error->rms_relative, 0.05);
    EXPECT_TRUE(result.warnings.empty());
}

// No knob lowers the error of printed forms, and none is named as if it did.
TEST(CloudBake, FidelityPaperStatesTheErrorOfItsFormulas) {
    Scene scene = make_layer_scene();
    scene.layers[0].paper = true;
    for (const bool has_target : {false, true}) {
        bake::BakeOptions options = layer_bake();
        if (has_target) options.error = 0.05;
        const bake::BakeResult result = bake_scene(scene, options);
        ASSERT_EQ(result.asset.clouds.records.size(), 1u);
        EXPECT_GT(result.layer_error->rms_relative, 0.1);
        ASSERT_EQ(result.warnings.size(), 1u);
        EXPECT_THAT(result.warnings[0].fault, HasSubstr("because fidelity \"paper\" takes"));
        EXPECT_THAT(result.warnings[0].remedy, HasSubstr("no option lowers it"));
        const auto json = nlohmann::json::parse(result.asset.provenance);
        EXPECT_EQ(json.at("layers").at(0).at("fidelity"), "paper");
        EXPECT_THAT(json.at("plan").at(0).at("reason"), HasSubstr("fidelity paper"));
        EXPECT_THAT(json.at("error").at("reference"), HasSubstr("printed forms"));
    }
}

TEST(CloudBake, EqualDropletsAndCoarseTablesAreWarnedOf) {
    Scene scene = make_layer_scene();
    scene.layers[0].gamma = 500;
    const bake::BakeResult result = bake_scene(scene, layer_bake());
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_THAT(result.warnings.back().fault, HasSubstr("ripples"));
}

TEST(CloudBake, CostsArePredictedForItsEntriesInBothFidelities) {
    Scene scene = make_layer_scene();
    for (const bool is_paper : {false, true}) {
        scene.layers[0].paper = is_paper;
        const bake::BakeResult result = bake_scene(scene, layer_bake());
        std::vector<bake::PlanEntry> plan = result.plan;
        const bake::StageRates rates{};
        const bake::CostPrediction cost = bake::predict_costs(
            {bake::all_effects(), scene, result.facts, result.knobs, rates, 1}, plan);
        for (const bake::StageReport& stage : result.stages) {
            if (stage.name.ends_with("of clouds")) {
                EXPECT_EQ(std::ranges::count(cost.stages, stage.name, &bake::StageCost::name), 1)
                    << stage.name;
            }
        }
        EXPECT_GT(plan[0].predicted_seconds, 0);
        EXPECT_GT(plan[1].predicted_seconds, 0);
        const auto bytes = static_cast<double>(4 * result.asset.clouds.value.size());
        EXPECT_NEAR(static_cast<double>(plan[0].predicted_bytes + plan[1].predicted_bytes), bytes,
                    0.01 * bytes);
    }
}

TEST(CloudBake, EffectsOfLayersConcernNothingElse) {
    bake::Knobs knobs;
    knobs.effects = {"radiosity"};
    EXPECT_FALSE(bake::check_effects(bake::all_effects(), make_scene({make_sphere(1)}), knobs));
    Scene scene = make_scene({make_sphere(1)});
    scene.layers.push_back(make_layer());
    EXPECT_TRUE(bake::check_effects(bake::all_effects(), scene, knobs));
}

}  // namespace
}  // namespace opaline::tests
