#include "bake/effects/volumes/bake_volumes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "bake/effects/volumes/volume_knobs.h"
#include "tests/bake/volumes/volume_support.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

Knobs coarse_knobs() {
    Knobs knobs = tests::knobs_for(Quality::draft);
    knobs.set(kVolumeWalks, 4);
    knobs.set(kVolumeSpacing, 4);
    return knobs;
}

TEST(BakeVolumes, AMethodThatThePlanLeavesOpenIsMeasuredAndTold) {
    formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.25), 3, 1, 0));
    Knobs knobs = coarse_knobs();
    VolumePlan plan = plan_volumes(scene, knobs);
    plan.layouts.at(0).method = VolumeMethod::automatic;
    StageLog log;
    VolumeFindings findings;
    const RayScene sky = tests::empty_space();
    ASSERT_TRUE(bake_volumes({scene, sky, plan.layouts, knobs}, {}, log, &findings).has_value());
    const std::vector<MethodMeasure>& measured = findings.methods;
    ASSERT_EQ(measured.size(), 1u);
    EXPECT_GT(measured[0].path_error, 0);
    EXPECT_EQ(measured[0].method, measured[0].path_error <= method_budget(knobs)
                                      ? VolumeMethod::path_integration
                                      : VolumeMethod::walks);
    tell_method(measured[0], method_budget(knobs), plan.entries);
    EXPECT_EQ(plan.entries.at(1).choice, name_of(measured[0].method));
    EXPECT_NE(plan.entries.at(1).reason.find("measured at"), std::string::npos);
}

TEST(BakeVolumes, DensityIsKeptToAnEvenStepOfTheBrick) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.4, 0.1), 3, 0.9f, 0.4f));
    const formats::Volumes volumes = tests::bake_volumes_of(scene, coarse_knobs());
    const formats::VolumeRecord& record = volumes.records.at(0);
    const formats::SparseGrid<float>& grid = scene.volumes[0].density;
    std::ptrdiff_t found = 0;
    tests::for_each_kept_voxel(
        volumes, record, [&](glm::ivec3 voxel, std::uint32_t brick, std::size_t i) {
            const float scale = volumes.density_scale[brick];
            const float kept = scale * static_cast<float>(volumes.density[512 * brick + i]);
            EXPECT_NEAR(kept, grid.at(voxel), 0.51 * static_cast<double>(scale) + 1e-12);
            found += grid.at(voxel) > 0 ? 1 : 0;
        });
    EXPECT_EQ(found, std::ranges::count_if(grid.value, [](float v) { return v > 0; }));
}

TEST(BakeVolumes, ASurfaceHidesTheLightBehindIt) {
    formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_ball_grid(0.5, 0.1), 1e-3f, 1, 0));
    scene.volumes.front().sigma_t = {0.5f, 0.5f, 0.5f};
    // A ceiling far wider than the ball, just above it.
    scene.primitives.push_back(tests::make_quad({-50, 1.3f, -50}, {100, 0, 0}, {0, 0, 100}));
    const auto rays = RayScene::build(scene, 1);
    ASSERT_TRUE(rays.has_value());
    const Knobs knobs = coarse_knobs();
    const formats::Volumes below = tests::bake_volumes_of(scene, *rays, knobs);
    const formats::Volumes open = tests::bake_volumes_of(scene, knobs);
    const formats::VolumeRecord& record = open.records.at(0);
    double shares = 0;
    for (std::uint32_t node = 0; node < record.node_count; ++node) {
        shares += tests::integrate_row(below.rows, record, node * record.terms()) /
                  tests::integrate_row(open.rows, record, node * record.terms());
    }
    EXPECT_NEAR(shares / record.node_count, 0.5, 0.03);
}

TEST(BakeVolumes, AVolumeThatOnlyAbsorbsHasDensityAndNoNodes) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.4, 0.1), 3, 0, 0));
    const formats::Volumes volumes = tests::bake_volumes_of(scene, coarse_knobs());
    ASSERT_EQ(volumes.records.size(), 1u);
    EXPECT_EQ(volumes.records[0].node_count, 0u);
    EXPECT_EQ(volumes.records[0].single_terms, 0u);
    EXPECT_GT(volumes.density.size(), 0u);
    EXPECT_EQ(volumes.rows.row_offset.size(), 1u);
}

TEST(BakeVolumes, ACancelledBakeLeavesNothing) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.4, 0.1), 3, 0.9f, 0.4f));
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    StageLog log;
    const Knobs knobs = coarse_knobs();
    const VolumePlan plan = plan_volumes(scene, knobs);
    const RayScene sky = tests::empty_space();
    const auto volumes = bake_volumes({scene, sky, plan.layouts, knobs}, context, log);
    ASSERT_TRUE(volumes.has_value());
    EXPECT_TRUE(volumes->records.empty());
}

}  // namespace
}  // namespace opaline::bake
