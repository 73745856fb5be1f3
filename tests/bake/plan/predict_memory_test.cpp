#include "bake/pipeline/predict_memory.h"

#include <gtest/gtest.h>

#include "tests/support/effects.h"

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

}  // namespace
}  // namespace opaline::bake
