#include "bake/effects/layers/bake_layers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "formats/opal/check_clouds.h"
#include "tests/bake/layers/layer_support.h"

namespace opaline::bake {
namespace {

const BakedLayers& draft() {
    static const BakedLayers kBaked = bake_layer(layer_scene(), layer_knobs_of(Quality::draft));
    return kBaked;
}

TEST(BakeLayers, EveryTableStandsWhereItsCountsSay) {
    const formats::Clouds& clouds = draft().clouds;
    ASSERT_EQ(clouds.records.size(), 1u);
    const formats::LayerRecord& record = clouds.records[0];
    EXPECT_EQ(clouds.value.size(), record.value_count());
    EXPECT_EQ(clouds.thickness.size(), record.thickness_count());
    EXPECT_EQ(clouds.ground.size(), record.ground_count());
    for (const float value : clouds.value) {
        ASSERT_TRUE(std::isfinite(value));
    }
    EXPECT_EQ(formats::find_clouds_fault(clouds.view()).what, "");
    EXPECT_EQ(formats::find_cloud_value_fault(clouds.view()).what, "");
}

TEST(BakeLayers, FramesFollowEachOtherInOneScale) {
    formats::Scene scene = layer_scene();
    formats::CloudLayer& layer = scene.layers[0];
    layer.thickness = {0, 10, 20, 30, 90, 60, 40, 0};
    layer.frames = 2;
    layer.frame_seconds = 45;
    layer.loops = true;
    const formats::Clouds clouds = bake_layer(scene, least_layer_knobs()).clouds;
    const formats::LayerRecord& record = clouds.records[0];
    EXPECT_EQ(record.frames, 2u);
    EXPECT_EQ(record.frame_seconds, 45);
    EXPECT_TRUE(record.loops() && !record.repeats());
    EXPECT_EQ(record.highest, 90);
    ASSERT_EQ(clouds.thickness.size(), 8u);
    EXPECT_EQ(clouds.thickness[4], 65535);
    EXPECT_NEAR(clouds.thickness[3] * 90 / 65535.0, 30, 0.001);
    EXPECT_EQ(formats::find_clouds_fault(clouds.view()).what, "");
    EXPECT_EQ(draft().clouds.records[0].frames, 1u);
    EXPECT_FALSE(draft().clouds.records[0].loops());
}

TEST(BakeLayers, ContrastIsFivePercentAtTheVisibility) {
    formats::Scene scene = layer_scene();
    scene.layers[0].visibility = 20000;
    const auto record = bake_layer(scene, least_layer_knobs()).clouds.records[0];
    EXPECT_NEAR(std::exp(-20000 * static_cast<double>(record.haze)), 0.05, 1e-6);
    EXPECT_EQ(draft().clouds.records[0].haze, 0);
}

// kappa = N0 Q pi <r^2>, and Q tends to 2 for large droplets: here it is 2.1 to 2.4.
TEST(BakeLayers, ExtinctionIsSomewhatMoreThanTwiceTheSectionOfTheDroplets) {
    const formats::LayerRecord& record = draft().clouds.records[0];
    const double section = 3e8 * mean_geometric_section({3e8, 3e-6, 2});
    for (const formats::LayerBand& band : record.band) {
        EXPECT_GT(static_cast<double>(band.kappa), 2.1 * section);
        EXPECT_LT(static_cast<double>(band.kappa), 2.4 * section);
        EXPECT_GT(band.peak_weight, 0.3f);
        EXPECT_LT(band.peak_weight, 0.6f);
        EXPECT_FLOAT_EQ(band.rest_kappa(), band.kappa * (1 - band.peak_weight));
    }
}

TEST(BakeLayers, LargerWavelengthsSeeSmallerDroplets) {
    // The forward peak of red light is wider, so less of it lies within the common angle.
    const auto& band = draft().clouds.records[0].band;
    EXPECT_LT(band[0].peak_weight, band[1].peak_weight);
    EXPECT_LT(band[1].peak_weight, band[2].peak_weight);
}

TEST(BakeLayers, StatedAngleOfThePeakIsKeptAndNoneMeansNoGlow) {
    formats::Scene scene = layer_scene();
    scene.layers[0].peak_angle = 0.1;
    EXPECT_FLOAT_EQ(bake_layer(scene, least_layer_knobs()).clouds.records[0].peak_angle, 0.1f);
    scene.layers[0].peak_angle = 0;
    const auto baked = bake_layer(scene, least_layer_knobs());
    EXPECT_EQ(baked.clouds.records[0].glow_count(), 0u);
    EXPECT_EQ(baked.clouds.records[0].band[1].peak_weight, 0);
}

TEST(BakeLayers, WithoutMultipleScatteringThereIsNoRadianceTable) {
    const formats::Scene scene = layer_scene();
    const LayerLayout layout{0, true, false, false};
    StageLog log;
    const auto baked = bake_layers({scene, {&layout, 1}, least_layer_knobs()}, {}, log);
    const formats::LayerRecord& record = baked->clouds.records[0];
    EXPECT_EQ(record.radiance_count(), 0u);
    EXPECT_EQ(baked->clouds.value.size(), record.value_count());
    EXPECT_FALSE(record.has_radiosity());
    EXPECT_EQ(log.size(), 2u);
}

TEST(BakeLayers, WithoutACloudThereIsTheGroundAlone) {
    formats::Scene scene = layer_scene();
    scene.layers[0].visibility = 5000;
    const LayerLayout layout{0, false, false, false};
    StageLog log;
    const auto baked = bake_layers({scene, {&layout, 1}, least_layer_knobs()}, {}, log);
    const formats::LayerRecord& record = baked->clouds.records[0];
    EXPECT_EQ(record.highest, 0);
    EXPECT_GT(record.haze, 0);
    EXPECT_EQ(baked->clouds.ground.size(), scene.layers[0].ground_albedo.size());
    EXPECT_EQ(baked->clouds.value.size(), record.value_count());
    EXPECT_EQ(formats::find_clouds_fault(baked->clouds.view()).what, "");
    EXPECT_TRUE(log.empty());
}

TEST(BakeLayers, AreTheSameForAnyNumberOfThreads) {
    const formats::Scene scene = layer_scene();
    const Knobs knobs = least_layer_knobs();
    const auto one = bake_layer(scene, knobs, 1), three = bake_layer(scene, knobs, 3);
    EXPECT_EQ(one.clouds.value, three.clouds.value);
}

TEST(BakeLayers, GroundWithoutAPictureIsBlack) {
    formats::Scene scene = layer_scene();
    scene.layers[0].ground_albedo.clear();
    const formats::Clouds clouds = bake_layer(scene, least_layer_knobs()).clouds;
    EXPECT_EQ(clouds.ground, (std::vector<std::array<std::uint8_t, 4>>{{0, 0, 0, 255}}));
    EXPECT_EQ(formats::find_clouds_fault(clouds.view()).what, "");
}

TEST(BakeLayers, ReportInterruptionAndDropletsOutOfRange) {
    formats::Scene scene = layer_scene();
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    const LayerLayout layout;
    StageLog log;
    const Knobs knobs = least_layer_knobs();
    const auto stopped = bake_layers({scene, {&layout, 1}, knobs}, context, log);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, formats::ErrorKind::interrupted);
    scene.layers[0].gamma = -1;
    const auto refused = bake_layers({scene, {&layout, 1}, knobs}, {}, log);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, formats::ErrorKind::usage);
    EXPECT_EQ(refused.error().diagnostics[0].where.rfind("layer 1 > ", 0), 0u);
}

}  // namespace
}  // namespace opaline::bake
