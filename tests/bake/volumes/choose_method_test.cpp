#include "bake/effects/volumes/choose_method.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bake/effects/volumes/volume_knobs.h"
#include "tests/bake/volumes/lit_space.h"

namespace opaline::bake {
namespace {

using tests::LitSpace;

formats::Volume ball(float sigma_t, float albedo, float g) {
    return tests::make_volume(tests::make_ball_grid(1, 0.1), sigma_t, albedo, g);
}
constexpr double kOneLength[] = {1.0};

NodeComparison compare(std::vector<float> paths, std::vector<float> walks,
                       std::vector<float> others) {
    return {std::move(paths), std::move(walks), std::move(others)};
}

TEST(ChooseMethod, ErrorOfPathsAndNoiseOfWalksAreToldApart) {
    // Light 1 everywhere, paths 10 % too bright, walks that scatter around the truth.
    constexpr std::size_t kRows = 20000;
    std::mt19937 random(1);
    std::normal_distribution<float> noise(0, 0.3f);
    NodeComparison node;
    for (std::size_t i = 0; i < kRows; ++i) {
        node.paths.push_back(1.1f);
        node.walks.push_back(1 + noise(random));
        node.others.push_back(1 + noise(random));
    }
    const MethodMeasure measure = compare_methods({&node, 1});
    EXPECT_NEAR(measure.path_error, 0.1, 0.015);
    EXPECT_NEAR(measure.walk_noise, 0.3, 0.01);
    EXPECT_EQ(measure.nodes, 1u);
}

TEST(ChooseMethod, ADarkVolumeMeasuresNothing) {
    const std::vector<NodeComparison> dark{compare({0, 0}, {0, 0}, {0, 0})};
    EXPECT_EQ(compare_methods(dark).path_error, 0);
}

Knobs with_method(VolumeMethod method, Quality quality = Quality::preview) {
    Knobs knobs = tests::knobs_for(quality);
    knobs.set(kVolumeMethod, static_cast<double>(method));
    return knobs;
}

TEST(ChooseMethod, PathsBeginInAsManyDirectionsAsAskedButInTwiceAsManyAsThereAreRows) {
    for (const std::uint32_t asked : {1u, 100u}) {
        Knobs knobs = with_method(VolumeMethod::path_integration);
        knobs.set(kVolumePaths, asked);
        const VolumeLayout layout =
            plan_volumes(tests::scene_of(ball(2, 1, 0.3f)), knobs).layouts.at(0);
        EXPECT_EQ(layout.views, std::max(asked, 2 * layout.often_terms));
    }
}

TEST(ChooseMethod, WalksOfFewScatteringsAreLessWorkThanPaths) {
    const VolumePlan plan =
        plan_volumes(tests::scene_of(ball(2, 1, 0.3f)), with_method(VolumeMethod::automatic));
    EXPECT_EQ(plan.layouts.at(0).method, VolumeMethod::walks);
    EXPECT_EQ(plan.entries.at(1).choice, "walks");
    EXPECT_THAT(plan.entries.at(1).reason, testing::HasSubstr("times the work"));
}

TEST(ChooseMethod, WhereWalksAreLongTheBakeMeasures) {
    const formats::Scene dense = tests::scene_of(ball(300, 1, 0));
    const VolumePlan plan = plan_volumes(dense, with_method(VolumeMethod::automatic));
    EXPECT_EQ(plan.layouts.at(0).method, VolumeMethod::automatic);
    EXPECT_EQ(plan.entries.at(1).choice, "");
    // Nothing fits where no error is allowed.
    const VolumePlan finest =
        plan_volumes(dense, with_method(VolumeMethod::automatic, Quality::reference));
    EXPECT_EQ(finest.layouts.at(0).method, VolumeMethod::walks);
}

TEST(ChooseMethod, AsksForOnePhaseFunction) {
    formats::Scene scene = tests::scene_of(ball(2, 1, 0.3f));
    scene.volumes.push_back(ball(2, 1, 0.3f));
    const Knobs knobs = with_method(VolumeMethod::path_integration);
    EXPECT_EQ(plan_volumes(scene, knobs).layouts.at(1).method, VolumeMethod::path_integration);
    scene.volumes.back() = ball(2, 1, 0.5f);
    const VolumePlan plan = plan_volumes(scene, knobs);
    EXPECT_EQ(plan.layouts.at(0).method, VolumeMethod::walks);
    EXPECT_THAT(plan.entries.at(1).reason, testing::HasSubstr("phase functions"));
}

TEST(ChooseMethod, MeasuresBothWaysAndTakesPathsThatFitTheBudget) {
    const LitSpace lit(ball(5, 0.99f, 0.75f), 4, make_light_cells(4));
    const VolumeWalkSpace walk = lit.walk();
    const PathCells groups = group_cells(lit.cells);
    const VolumePathSpace space{walk, groups, lit.space.volumes.front().phase.moments(),
                                kOneLength};
    const VolumeLayout layout{.often_terms = 4, .spacing = 4, .walks = 400, .views = 16};
    const auto& grid = lit.scene.volumes.front().density;
    const MethodMeasure strict = measure_method(space, grid, layout, 0.01);
    EXPECT_EQ(strict.method, VolumeMethod::walks);
    EXPECT_NEAR(strict.path_error, 0.43, 0.1);
    EXPECT_GT(strict.walk_noise, 0.02);
    const MethodMeasure lenient = measure_method(space, grid, layout, 0.6);
    EXPECT_EQ(lenient.method, VolumeMethod::path_integration);
    EXPECT_EQ(lenient.path_error, strict.path_error);
    // The error of the model stays, the noise falls.
    VolumeLayout more = layout;
    more.walks = 1600;
    const MethodMeasure again = measure_method(space, grid, more, 0.01);
    EXPECT_NEAR(again.walk_noise / strict.walk_noise, 0.5, 0.1);
    EXPECT_NEAR(again.path_error / strict.path_error, 1, 0.1);
}

}  // namespace
}  // namespace opaline::bake
