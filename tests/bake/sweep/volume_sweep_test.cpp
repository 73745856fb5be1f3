#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/lab/sweep/analysis.h"
#include "bake/lab/sweep/tables.h"
#include "tests/bake/sweep/enough_time.h"
#include "tests/support/effects.h"
#include "tests/support/volumes.h"

namespace opaline::bake {
namespace {

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
