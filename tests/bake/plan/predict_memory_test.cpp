#include <gtest/gtest.h>

#include <algorithm>

#include "bake/pipeline/cost_model.h"
#include "bake/pipeline/predict_memory.h"
#include "bake/pipeline/savings.h"
#include "bake/scene/inspect_scene.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

Knobs knobs_of(Quality quality) {
    BakeOptions options;
    options.quality = quality;
    return resolve_knobs(options).value();
}

double predict(formats::SceneCounts scene, Quality quality, unsigned threads = 2) {
    return predict_memory(all_effects(), count_memory(scene), knobs_of(quality), threads).bytes();
}

TEST(PredictMemory, GrowsWithEverythingItDependsOn) {
    const formats::SceneCounts one{1, 10000, 60000};
    const double base = predict(one, Quality::preview);
    EXPECT_GT(predict({2, 10000, 60000}, Quality::preview), base);
    EXPECT_GT(predict({1, 20000, 60000}, Quality::preview), base);
    EXPECT_GT(predict({1, 10000, 90000}, Quality::preview), base);
    EXPECT_GT(predict(one, Quality::preview, 16), base);
    EXPECT_LT(predict(one, Quality::draft), base);
    EXPECT_GT(predict(one, Quality::production), base);
}

TEST(PredictMemory, PartsAddUpAndTheLargestIsNamed) {
    const MemoryPrediction prediction =
        predict_memory(all_effects(), count_memory(formats::SceneCounts{200000, 800000, 1200000}),
                       knobs_of(Quality::draft), 2);
    double sum = 0;
    for (const auto& part : prediction.parts) {
        EXPECT_GE(part.bytes, 0);
        sum += part.bytes;
    }
    EXPECT_DOUBLE_EQ(prediction.bytes(), sum);
    EXPECT_EQ(prediction.largest().name, "its primitives and instances");
}

TEST(PredictMemory, HugeScenesOverflowNothing) {
    const std::uint64_t most = std::uint64_t{1} << 60;
    EXPECT_GT(predict({most, most, most}, Quality::reference), 1e18);
}

TEST(PredictMemory, MediaTakeSamplesAndWiderRows) {
    formats::Scene scene;
    scene.materials.resize(1);
    scene.primitives.resize(1);
    scene.primitives[0].position.resize(1000);
    scene.primitives[0].index.resize(6000);
    const Knobs knobs = knobs_of(Quality::preview);
    const double opaque =
        predict_memory(all_effects(), count_memory(all_effects(), scene, {}, knobs), knobs, 1)
            .bytes();
    EXPECT_DOUBLE_EQ(
        opaque,
        predict_memory(all_effects(), count_memory(formats::SceneCounts{1, 1000, 6000}), knobs, 1)
            .bytes())
        << "known by size alone: as if opaque";
    scene.materials[0].medium = formats::Medium{};
    const MemoryPrediction wax =
        predict_memory(all_effects(), count_memory(all_effects(), scene, {}, knobs), knobs, 1);
    EXPECT_GT(wax.bytes(), opaque);
    EXPECT_EQ(wax.largest().name, "surface samples");
}

TEST(PredictMemory, LightOfOtherSurfacesIsKeptAndItsColourWidensRows) {
    const Knobs knobs = knobs_of(Quality::preview);
    MemoryCounts counts = count_memory(formats::SceneCounts{1, 1000, 6000});
    const double alone = predict_memory(all_effects(), counts, knobs, 1).bytes();
    counts.light_bytes = 1e6;
    EXPECT_DOUBLE_EQ(predict_memory(all_effects(), counts, knobs, 1).bytes(), alone + 1e6);
    counts.opaque_bands = 3;
    EXPECT_GT(predict_memory(all_effects(), counts, knobs, 1).bytes(), alone + 1e6);
}

struct Planned {
    formats::Scene scene;
    SceneFacts facts;
    std::vector<PlanEntry> plan;
    CostPrediction cost;
};

// A grey ball over an opaque floor, and what each entry saves.
Planned plan_ball(const formats::Medium& medium) {
    formats::Primitive floor = tests::make_quad({-3, -1.02f, -3}, {0, 0, 6}, {6, 0, 0}, 8);
    floor.material = 1;
    Planned p{tests::make_translucent_scene({tests::make_sphere(2), floor}, medium), {}, {}, {}};
    p.facts = inspect_scene(p.scene);
    p.plan = plan_bake(p.scene, p.facts, {});
    p.cost = predict_costs(p.scene, p.facts, {}, {}, 2, p.plan);
    predict_savings(p.scene, p.facts, {}, {}, 2, p.plan);
    return p;
}

TEST(Savings, AreWhatTurningTheEntryOnWouldAdd) {
    const Planned p = plan_ball(tests::make_grey_medium(40, 1));
    const auto colour = std::find_if(p.plan.begin(), p.plan.end(), [](const PlanEntry& entry) {
        return entry.name == "light.colour";
    });
    ASSERT_FALSE(colour->on);
    std::vector<PlanEntry> forced = p.plan;
    forced[static_cast<std::size_t>(colour - p.plan.begin())].on = true;
    const CostPrediction more = predict_costs(p.scene, p.facts, {}, {}, 2, forced);
    EXPECT_GT(colour->saved_seconds, 0);
    EXPECT_GT(colour->saved_bytes, 0u);
    EXPECT_NEAR(colour->saved_seconds, more.seconds - p.cost.seconds, 1e-9 * more.seconds);
    EXPECT_EQ(colour->saved_bytes, more.bytes - p.cost.bytes);
}

// A medium that lets nothing out saves what scattering would take, and nothing by not being shown
// as a diffuse surface: that would be another look, not more of the same.
TEST(Savings, AreOfEffectsThatAreOffAndNotOfAnotherLook) {
    const Planned p = plan_ball(tests::make_grey_medium(1e-4f, 1));
    for (const char* effect : {"multiple", "single"}) {
        ASSERT_FALSE(find_entry(p.plan, effect, 0)->on);
        EXPECT_GT(find_entry(p.plan, effect, 0)->saved_seconds, 0) << effect;
    }
    ASSERT_FALSE(find_entry(p.plan, "direct", 0)->on);
    for (const PlanEntry& entry : p.plan) {
        const bool may_save = !entry.on && entry.name != "direct";
        EXPECT_TRUE(may_save || (entry.saved_seconds == 0 && entry.saved_bytes == 0))
            << entry.name << " of " << entry.subject.name;
    }
}

TEST(Savings, LeaveThePredictionAsItWas) {
    Planned p = plan_ball(tests::make_grey_medium(40, 1));
    double seconds = p.cost.shared_seconds;
    for (const PlanEntry& entry : p.plan) {
        EXPECT_TRUE(entry.on || entry.predicted_seconds == 0) << entry.name;
        seconds += entry.predicted_seconds;
    }
    EXPECT_NEAR(seconds, p.cost.seconds, 1e-9 * seconds);
}

}  // namespace

}  // namespace opaline::bake
