#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "bake/effects/volumes/bake_volumes.h"
#include "bake/effects/volumes/phase_table.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/physics/phase.h"
#include "bake/trace/density/scaled_phase.h"
#include "formats/opal/phase_table.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/bake/volumes/volume_support.h"
#include "tests/support/cut_phase.h"
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

using formats::eval_phase_table;
using formats::integrate_phase_table;
using formats::kPhaseEntries;

// The largest relative error over all angles, every 0.02 degrees.
template <class Exact>
double worst_error(const std::vector<float>& table, Exact exact) {
    double worst = 0;
    for (int i = 0; i <= 9000; ++i) {
        const double c = std::cos(i * std::numbers::pi / 9000);
        const double found = static_cast<double>(eval_phase_table(table, static_cast<float>(c)));
        worst = std::max(worst, std::abs(found / exact(c) - 1));
    }
    return worst;
}

TEST(PhaseTableOfVolumes, IntegratesToOne) {
    for (const float g : {-0.95f, -0.5f, 0.0f, 0.3f, 0.5f, 0.75f, 0.85f, 0.95f, 0.99f}) {
        const formats::PhaseFunction phase = tests::hg(g);
        const std::vector<float> table = tabulate_phase(phase, scale_phase(phase).peak);
        ASSERT_EQ(table.size(), kPhaseEntries);
        EXPECT_NEAR(integrate_phase_table(table), 1, 1e-6) << g;
        EXPECT_GE(*std::ranges::min_element(table), 0);
    }
}

// The share g^5 is the peak that the bake takes out; what is above the cut must be just that.
TEST(PhaseTableOfVolumes, IsHenyeyGreensteinBelowTheCutThatLeavesThePeak) {
    for (const double g : {0.5, 0.75, 0.85, 0.95}) {
        const formats::PhaseFunction phase = tests::hg(g);
        const double peak = scale_phase(phase).peak;
        const tests::CutPhase exact = tests::make_cut_phase(g);
        ASSERT_NEAR(peak, exact.peak, 1e-6);
        const std::vector<float> table = tabulate_phase(phase, peak);
        // Rounded off at the edge, where the slope changes at once.
        EXPECT_LT(worst_error(table, exact), 0.03) << g;
        double worst = 0;
        for (int i = 0; i <= 3600; ++i) {
            const double angle = i * std::numbers::pi / 3600, c = std::cos(angle);
            if (std::abs(angle - std::acos(exact.edge)) < 0.02) continue;
            const auto found = static_cast<double>(eval_phase_table(table, static_cast<float>(c)));
            worst = std::max(worst, std::abs(found / exact(c) - 1));
        }
        EXPECT_LT(worst, 3e-3) << g;
    }
}

TEST(PhaseTableOfVolumes, IsThePhaseFunctionItselfWithoutAPeak) {
    for (const double g : {-0.85, -0.4, 0.3}) {
        const formats::PhaseFunction phase = tests::hg(g);
        ASSERT_EQ(scale_phase(phase).peak, 0);
        EXPECT_LT(worst_error(tabulate_phase(phase, 0),
                              [&](double c) { return henyey_greenstein(c, phase.g); }),
                  0.006)
            << g;
    }
    EXPECT_LT(worst_error(tabulate_phase(tests::rayleigh(), 0),
                          [](double c) { return 3 * (1 + c * c) / (16 * std::numbers::pi); }),
              2e-4);
    EXPECT_LT(worst_error(tabulate_phase({}, 0), [](double) { return 0.25 / std::numbers::pi; }),
              1e-6);
}

// A ring 0.15 degrees wide, much less than a step, and as wide a forward peak.
TEST(PhaseTableOfVolumes, NarrowPeaksKeepTheirLight) {
    for (const double angle : {0.0, 42.3, 137.9}) {
        const auto cosine = [&](double degrees) {
            return static_cast<float>(std::cos((angle + degrees) * std::numbers::pi / 180));
        };
        const formats::PhaseFunction phase =
            angle > 0
                ? tests::table_of({-1, cosine(0.15), cosine(0.075), cosine(0), 1}, {0, 0, 1, 0, 0})
                : tests::table_of({-1, cosine(0.15), 1}, {0, 0, 1});
        const std::vector<float> table = tabulate_phase(phase, 0);
        EXPECT_NEAR(integrate_phase_table(table), 1, 1e-6);
        const double coordinate = static_cast<double>(formats::phase_coordinate(cosine(0.075)));
        for (std::size_t i = 0; i < kPhaseEntries; ++i) {
            if (std::abs(static_cast<double>(i) - coordinate) > 1.2) {
                EXPECT_EQ(table[i], 0) << angle << " entry " << i;
            }
        }
    }
}

}  // namespace

}  // namespace opaline::bake
