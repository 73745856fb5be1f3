#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bake/effects/layers/plan_layers.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/lab/sweep/analysis.h"
#include "bake/lab/sweep/run_point.h"
#include "bake/lab/sweep/tables.h"
#include "tests/bake/layers/layer_support.h"
#include "tests/bake/sweep/enough_time.h"
#include "tests/support/effects.h"
#include "tests/support/volumes.h"

namespace opaline::bake {
namespace {

SweepSubject subject_of_layer(const formats::Scene& scene) {
    const Knobs preview = *resolve_knobs(all_effects(), {});
    return sweep_subject(all_effects(), scene, plan_layers(scene, preview).entries, preview);
}

TEST(LayerSweep, LaddersOfALayerAloneAreThoseOfItsTwoKnobs) {
    const SweepSubject subject = subject_of_layer(layer_scene());
    EXPECT_TRUE(subject.is_layer_alone());
    EXPECT_THAT(subject.knobs, ::testing::UnorderedElementsAre(&kCloudStep, &kCloudNodes));
    std::set<Ladder> ladders;
    const auto points = make_ladders(LadderRequest{all_effects(), subject, {}}, Quality::preview);
    for (std::size_t a = 0; a < points.size(); ++a) {
        for (const Rung& rung : points[a].rungs) {
            ladders.insert(rung.ladder);
        }
        for (std::size_t b = 0; b < a; ++b) {
            EXPECT_FALSE(same_bake(points[a].knobs, points[b].knobs, subject))
                << points[a].label << " and " << points[b].label;
        }
    }
    EXPECT_EQ(ladders, (std::set<Ladder>{ladder_of(kCloudStep), ladder_of(kCloudNodes),
                                         Ladders::preset, Ladders::diagonal}));
}

TEST(LayerSweep, TruthsOfALayerAloneAreFineTablesNotAllCoefficients) {
    const auto truths =
        make_truths(LadderRequest{all_effects(), subject_of_layer(layer_scene()), {}});
    ASSERT_EQ(truths.size(), 3u);
    for (std::size_t i = 0; i < truths.size(); ++i) {
        EXPECT_THAT(truths[i].label, ::testing::Not(::testing::HasSubstr("coefficients")));
        if (i > 0) {
            EXPECT_LT(truths[i].knobs[kCloudNodes], truths[i - 1].knobs[kCloudNodes]);
            EXPECT_GT(truths[i].knobs[kCloudStep], truths[i - 1].knobs[kCloudStep]);
        }
    }
}

TEST(LayerSweep, RadianceOfEachGroupIsRelativeToTheFirstBake) {
    std::vector<PointRecord> points(2);
    points[0].layer_radiance =
        read_layer_radiance(bake_layer(layer_scene(), least_layer_knobs()).clouds.view());
    ASSERT_EQ(points[0].layer_radiance.size(), 3u * 4 * 3 * 2 * 20);
    for (const double radiance : points[0].layer_radiance) {
        EXPECT_TRUE(std::isfinite(radiance) && radiance > 0);
    }
    for (const double radiance : points[0].layer_radiance) {
        points[1].layer_radiance.push_back(1.5 * radiance);
    }
    scale_layer_radiance(points);
    for (std::size_t group = 0; group < 72; ++group) {
        double square = 0;
        for (std::size_t i = 20 * group; i < 20 * (group + 1); ++i) {
            square += points[0].layer_radiance[i] * points[0].layer_radiance[i] / 20;
        }
        EXPECT_NEAR(square, 1, 1e-9);
    }
    EXPECT_NEAR(relative_difference(points[1].layer_radiance, points[0].layer_radiance), 0.5, 1e-9);
    std::vector<PointRecord> none;
    scale_layer_radiance(none);
}

TEST(LayerSweep, AScenesErrorIsTheLargerOneOfItsLayerAndTheRest) {
    LayerErrorReport layer;
    layer.rms_relative = 0.02;
    layer.reference = "slabs";
    layer.radiances_checked = 7;
    ErrorReport alone;
    take_larger(alone, layer);
    EXPECT_EQ(alone.rms_relative, 0.02);
    EXPECT_EQ(alone.receivers_checked, 7u);
    ErrorReport rest;
    rest.rms_relative = 0.05;
    rest.receivers_checked = 3;
    take_larger(rest, layer);
    EXPECT_EQ(rest.rms_relative, 0.05);
    EXPECT_THAT(rest.reference, ::testing::HasSubstr("clouds: slabs"));
}

TEST(LayerSweep, PointsOfALayerAloneNeedNoTestLightsAndNoPathTracing) {
    SweepOptions options;
    options.seconds = 4;
    options.bake.threads = 2;
    const auto result = tests::sweep_with_enough_time(layer_scene(100, 1e-6), options, 3);
    ASSERT_TRUE(result.has_value());
    EXPECT_TRUE(result->lights.empty());
    EXPECT_FALSE(result->reference);
    ASSERT_GT(result->points.size(), 2u);
    for (const PointRecord& point : result->points) {
        ASSERT_TRUE(point.layer);
        EXPECT_EQ(point.error.rms_relative, point.layer->rms_relative);
        EXPECT_EQ(point.total.receivers_checked, 0u);
        EXPECT_FALSE(point.picture.pixel.empty());
        for (const StageReport& stage : point.stages) {
            EXPECT_NE(stage.name, "test lights");
        }
    }
    const PointRecord& truth = result->points[result->truth];
    EXPECT_LT(truth.error.rms_relative, result->points.front().error.rms_relative);
    EXPECT_GT(result->points.front().against_finest.rms_relative, 0.005);
    const auto json = make_sweep_json(*result, analyse_sweep(*result));
    EXPECT_GT(json["points"][0]["layer_error"]["tables"], 0);
    EXPECT_EQ(json["knobs"], (nlohmann::ordered_json{"cloud_step", "cloud_nodes"}));
    EXPECT_EQ(json["plan"].size(), 3u);
}

formats::Scene make_cloud() {
    formats::Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(tests::make_volume(tests::make_blob(0.4, 0.25), 4, 0.9f, 0.5f));
    return scene;
}

SweepSubject subject_of(const formats::Scene& scene) {
    const Knobs preview = *resolve_knobs(all_effects(), {});
    return sweep_subject(all_effects(), scene, plan_volumes(scene, preview).entries, preview);
}

TEST(VolumeSweep, LaddersOfACloudAloneAreThoseOfItsKnobs) {
    const SweepSubject subject = subject_of(make_cloud());
    EXPECT_TRUE(subject.has_volumes);
    EXPECT_FALSE(subject.has_surfaces);
    std::set<Ladder> ladders;
    for (const SweepPoint& point : make_ladders({all_effects(), subject, {}}, Quality::preview)) {
        for (const Rung& rung : point.rungs) {
            ladders.insert(rung.ladder);
        }
    }
    for (const KnobSpec* knob :
         {&kVolumeSpacing, &kVolumeCoefficients, &kVolumeWalks, &kVolumeTerms}) {
        EXPECT_TRUE(ladders.contains(ladder_of(*knob))) << knob->name;
    }
    EXPECT_TRUE(ladders.contains(ladder_of(kVolumeMethod))) << "one line a method";
    EXPECT_TRUE(ladders.contains(ladder_of(kVolumePaths))) << "though auto takes walks";
    EXPECT_TRUE(ladders.contains(Ladders::preset));
    EXPECT_TRUE(ladders.contains(Ladders::diagonal));
    EXPECT_FALSE(ladders.contains(Ladders::coefficients));
    EXPECT_FALSE(ladders.contains(Ladders::grid));
}

TEST(VolumeSweep, PointsHaveErrorsOfFourKindsOfLight) {
    SweepOptions options;
    options.seconds = 25;
    options.bake.threads = 2;
    const auto result = tests::sweep_with_enough_time(make_cloud(), options, 3);
    ASSERT_TRUE(result.has_value());
    EXPECT_THAT(result->lights, ::testing::ElementsAre("forward", "side", "back", "even"));
    ASSERT_GT(result->points.size(), 2u);
    double coarsest = 0;
    for (const PointRecord& point : result->points) {
        ASSERT_EQ(point.volumes.by_light.size(), 4u);
        EXPECT_GT(point.total.rms_relative, 0);
        EXPECT_EQ(point.total.rms_relative, point.error.rms_relative);
        coarsest = std::max(coarsest, point.error.rms_relative);
    }
    EXPECT_LT(result->points[result->truth].error.rms_relative, coarsest);
    const SweepAnalysis analysis = analyse_sweep(*result);
    const auto json = make_sweep_json(*result, analysis);
    EXPECT_EQ(json["points"][0]["volume_error"]["by_light"].size(), 4u);
    EXPECT_EQ(json["plan"].size(), 2u);
}

}  // namespace

}  // namespace opaline::bake
