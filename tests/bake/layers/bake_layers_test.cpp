#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "bake/effects/layers/bake_layers.h"
#include "bake/effects/layers/layer_tables.h"
#include "bake/effects/layers/layer_work.h"
#include "bake/effects/layers/plan_layers.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/solve_slab.h"
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

const PlanEntry& entry_of(const LayerPlan& plan, std::string_view name) {
    return *std::ranges::find(plan.entries, name, &PlanEntry::name);
}

LayerPlan plan_of(float thickness, const Knobs& knobs = {}) {
    return plan_layers(layer_scene(thickness), knobs);
}

// What a finely sampled layer does at the bound's cosine: the largest of three bands. All layers
// have the same droplets.
struct Truth {
    double scattered = 0, often = 0;  // 1 - T_0, 1 - T_0 - T_1 - R_1
    double reflected = 0;             // R_ms
    double mean_t = 1;
};

Truth truth_of(const formats::CloudLayer& layer) {
    static const DropletBands kBands = *scatter_bands(layer, {0.3, 400, 2000}, {});
    Truth most;
    for (const DropletBand& band : kBands) {
        SlabRequest request;
        request.optical_depth =
            rest_extinction(band.split, band.kappa) * static_cast<double>(layer.thickness[0]);
        request.cosine = {kBoundCosine};
        request.orders = 2;
        const SlabSolution slab = solve_slab(rest_medium(band.split, 48), request).front();
        const double straight = slab.order[0].transmittance[0];
        most.scattered = std::max(most.scattered, 1 - straight);
        most.often = std::max(most.often, 1 - straight - slab.order[1].transmittance[0] -
                                              slab.order[1].reflectance[0]);
        most.reflected = std::max(most.reflected, slab.total.reflectance[0]);
        most.mean_t = std::min(most.mean_t, slab.total.mean_transmittance);
    }
    return most;
}

TEST(PlanLayers, LayerIsOffWithoutThicknessAndWithoutDroplets) {
    for (const bool has_droplets : {true, false}) {
        formats::Scene scene = layer_scene(has_droplets ? 0.0f : 100.0f);
        scene.layers[0].droplets = has_droplets ? 3e8 : 0;
        Knobs knobs;
        knobs.simulate_all = true;
        const LayerPlan plan = plan_layers(scene, knobs);
        ASSERT_EQ(plan.layouts.size(), 1u);
        EXPECT_FALSE(plan.layouts[0].cloud);
        ASSERT_EQ(plan.entries.size(), 3u);
        for (const PlanEntry& entry : plan.entries) {
            EXPECT_FALSE(entry.on);
            EXPECT_EQ(entry.bound, 0);
        }
    }
}

TEST(PlanLayers, ThickLayerHasEverythingAndItsSubjectIsTheLayer) {
    const LayerPlan plan = plan_of(100);
    ASSERT_EQ(plan.layouts.size(), 1u);
    EXPECT_TRUE(plan.layouts[0].cloud);
    EXPECT_TRUE(plan.layouts[0].often);
    EXPECT_TRUE(plan.layouts[0].radiosity);
    for (const PlanEntry& entry : plan.entries) {
        EXPECT_TRUE(entry.on);
        EXPECT_EQ(entry.subject.kind, Subject::Kind::layer);
        EXPECT_EQ(entry.subject.name, "layer 1");
    }
}

// Layers without the forward peak lose less light than the bound, which counts the peak as lost.
TEST(PlanLayers, CountsAndBoundsFollowFromTheLargestThicknessAlone) {
    const formats::Scene all = layer_scene(100);
    formats::Scene largest = all;
    largest.layers[0].thickness.resize(1);
    EXPECT_EQ(bound_layer(largest.layers[0]).cloud, bound_layer(all.layers[0]).cloud);
    const LayerLayout layout{0, true, true, false};
    EXPECT_EQ(count_layer_work(largest.layers[0], layout, {}).bytes,
              count_layer_work(all.layers[0], layout, {}).bytes);
    EXPECT_EQ(layer_memory(largest.layers[0], {}), layer_memory(all.layers[0], {}));
}

// Under even light of radiance 1 the ground sends up rho Tbar / (1 - rho Rbar) at most if the layer
// is even, and rho where it has gaps; the layer sends back or passes on less than the bound.
TEST(PlanLayers, LayersScatterLessThanTheirBoundsAndAGoodPartOfThem) {
    for (const float thickness : {0.01f, 0.3f, 1.0f, 3.0f, 100.0f, 20000.0f}) {
        SCOPED_TRACE(thickness);
        const formats::CloudLayer layer = layer_scene(thickness).layers[0];
        const LayerBounds bound = bound_layer(layer);
        const Truth truth = truth_of(layer);
        EXPECT_LE(truth.scattered, bound.cloud);
        EXPECT_GE(truth.scattered, bound.cloud / 3);
        if (thickness > 0.1f) {  // thinner: both are 1e-7, which the solver rounds
            EXPECT_LE(truth.often, bound.often);
            EXPECT_GE(truth.often, 0.7 * bound.often);
        }
        const double rho = 0.2159;  // of the sRGB code 128
        const double even = rho * truth.mean_t / (1 - rho * (1 - truth.mean_t)) * truth.reflected;
        EXPECT_LE(even, bound.radiosity);
        EXPECT_LE(rho * truth.reflected, bound.radiosity);  // one cloud over an open ground
        if (thickness == 20000) {
            EXPECT_GE(rho * truth.reflected, 0.9 * bound.radiosity);
        }
    }
}

TEST(PlanLayers, ThinLayerScattersOnceAtMostUnlessForcedOrAskedForLessError) {
    const float thickness = 0.3f;
    const LayerPlan plan = plan_of(thickness);
    EXPECT_TRUE(entry_of(plan, "cloud").on);
    const PlanEntry& often = entry_of(plan, "cloud.multiple");
    EXPECT_FALSE(often.on);
    EXPECT_GT(often.bound, 0);
    EXPECT_FALSE(plan.layouts[0].often);
    Knobs all;
    all.simulate_all = true;
    const LayerPlan forced = plan_of(thickness, all);
    EXPECT_TRUE(entry_of(forced, "cloud.multiple").forced);
    EXPECT_TRUE(forced.layouts[0].often);
    Knobs exact;
    exact.error_target = 1e-3;
    EXPECT_TRUE(entry_of(plan_of(thickness, exact), "cloud.multiple").on);
}

TEST(PlanLayers, BlackGroundNeedsNoRadiosity) {
    formats::Scene scene = layer_scene();
    scene.layers[0].ground_albedo = {{0, 0, 0, 255}};
    Knobs all;
    all.simulate_all = true;
    const LayerPlan plan = plan_layers(scene, all);
    EXPECT_FALSE(entry_of(plan, "radiosity").on);
    EXPECT_FALSE(plan.layouts[0].radiosity);
}

TEST(PlanLayers, EffectsThatAreNotWantedAreLeftOut) {
    Knobs knobs;
    knobs.effects = {"cloud"};
    const LayerPlan alone = plan_of(100, knobs);
    EXPECT_TRUE(alone.layouts[0].often);
    EXPECT_FALSE(alone.layouts[0].radiosity);
    knobs.effects = {"direct"};
    const LayerPlan neither = plan_of(100, knobs);
    EXPECT_FALSE(neither.layouts[0].cloud || neither.layouts[0].often ||
                 neither.layouts[0].radiosity);
}

TEST(PlanLayers, BoundOfDropletsOutOfRangeIsUnknown) {
    formats::Scene scene = layer_scene();
    scene.layers[0].effective_radius = 1;
    EXPECT_TRUE(std::isnan(bound_layer(scene.layers[0]).cloud));
    EXPECT_EQ(plan_layers(scene, {}).layouts.size(), 1u);
}

}  // namespace

}  // namespace opaline::bake
