#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "bake/effects/volumes/largest_light.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_work.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/density/scaled_phase.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

VolumePlan plan_of(float sigma_t, float albedo, float g, const Knobs& knobs) {
    return plan_volumes(
        tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.25), sigma_t, albedo, g)),
        knobs);
}

Knobs preview() {
    return tests::knobs_for(Quality::preview);
}

TEST(PlanVolumes, LightUnderTheBudgetIsLeftOutAndForwardScatteringTakesMoreTerms) {
    constexpr struct {
        const char* name;
        float sigma_t, albedo, g;
        bool once, often;
        std::uint32_t once_terms, least_often_terms, most_often_terms;
    } kRows[] = {{"thin", 1e-4f, 1, 0, false, false, 0, 0, 0},
                 {"scatters once", 3e-3f, 1, 0, true, false, 1, 0, 0},
                 {"dense", 3, 1, 0, true, true, 1, 1, 1},
                 {"black", 3, 0, 0.5f, false, false, 0, 0, 0},
                 {"nearly even", 3, 1, 0.05f, true, true, 4, 1, 4},
                 {"forward", 3, 1, 0.85f, true, true, 25, 2, 24}};
    for (const auto& row : kRows) {
        SCOPED_TRACE(row.name);
        const VolumePlan plan = plan_of(row.sigma_t, row.albedo, row.g, preview());
        EXPECT_EQ(plan.entries.at(0).on, row.once);
        EXPECT_EQ(plan.entries.at(1).on, row.often);
        const bool absorbs = row.albedo == 0;
        ASSERT_EQ(plan.layouts.size(), row.once || absorbs ? 1u : 0u);
        EXPECT_EQ(plan.entries[0].reason.find("absorbs") != std::string::npos, absorbs);
        if (!row.once) {
            EXPECT_LT(plan.entries[0].bound, 1.0 / 512);
            EXPECT_TRUE(plan.layouts.empty() || !plan.layouts[0].has_nodes());
            continue;
        }
        EXPECT_EQ(plan.layouts[0].once_terms, row.once_terms);
        EXPECT_GE(plan.layouts[0].often_terms, row.least_often_terms);
        EXPECT_LE(plan.layouts[0].often_terms, row.most_often_terms);
    }
    const VolumePlan thin = plan_of(3e-3f, 1, 0, preview());
    EXPECT_NEAR(thin.entries[1].bound, thin.entries[0].bound * thin.entries[0].bound, 1e-12);
}

TEST(PlanVolumes, NamedEffectsAreAllThatIsBaked) {
    Knobs knobs = preview();
    knobs.effects = {"volume-multiple"};
    const VolumePlan plan = plan_of(3, 1, 0, knobs);
    EXPECT_FALSE(plan.entries.at(0).on);
    EXPECT_TRUE(plan.entries.at(1).on);
    EXPECT_EQ(plan.layouts.at(0).once_terms, 0u);
    EXPECT_EQ(plan.layouts[0].often_terms, 1u);
}

TEST(PlanVolumes, EverythingIsSimulatedWhereThatIsAskedFor) {
    Knobs knobs = preview();
    knobs.simulate_all = true;
    const VolumePlan thin = plan_of(1e-4f, 1, 0, knobs);
    EXPECT_TRUE(thin.entries.at(0).on && thin.entries.at(1).on);
    EXPECT_TRUE(thin.entries[0].forced);
    EXPECT_EQ(thin.layouts.size(), 1u);
}

TEST(PlanVolumes, GivenKnobsAreTaken) {
    Knobs knobs = preview();
    knobs.set(kVolumeSpacing, 8);
    knobs.set(kVolumeTerms, 4);
    const VolumeLayout layout = plan_of(3, 1, 0.5f, knobs).layouts.at(0);
    EXPECT_EQ(layout.spacing, 8u);
    EXPECT_EQ(layout.often_terms, 4u);
}

// Of walks in all directions alike a share counts that 1 / (4 pi int p'^2) is.
TEST(PlanVolumes, MoreWalksLeaveWhereMediaScatterForwardSoThatAsManyCount) {
    const double walks = preview()[kVolumeWalks];
    EXPECT_EQ(plan_of(3, 1, 0, preview()).layouts.at(0).walks, walks);
    EXPECT_EQ(plan_of(3, 0, 0, preview()).layouts.at(0).walks, 0u) << "none are needed";
    for (const float g : {0.5f, 0.85f}) {
        Knobs knobs = preview();
        knobs.set(kVolumeTerms, 25);
        const ScaledPhase phase =
            scale_phase(tests::make_volume(tests::make_blob(0.4, 0.1), 3, 1, g).phase);
        double squares = 0;
        constexpr int kSteps = 2000;
        for (int i = 0; i < kSteps; ++i) {
            const float p = eval_scaled(phase, -1 + (static_cast<float>(i) + 0.5f) * 2 / kSteps);
            squares += 2 * std::numbers::pi * 2.0 / kSteps * static_cast<double>(p * p);
        }
        EXPECT_NEAR(plan_of(3, 1, g, knobs).layouts.at(0).walks,
                    4 * std::numbers::pi * squares * walks, 0.01 * walks)
            << g;
    }
}

TEST(PlanVolumes, TheDepthOfNoLineExceedsTheBound) {
    const formats::Volume blob = tests::make_volume(tests::make_blob(0.4, 0.1), 3, 1, 0);
    EXPECT_GT(largest_depth(blob)[0], 3 * 0.4 * 2.5066);
}

formats::Volume box_of_cells(double ripple) {
    return tests::make_volume(
        formats::fill_grid(glm::ivec3(-16), glm::ivec3(16), 0.1,
                           [&](glm::ivec3 at) { return at.x % 2 == 0 ? 1.0 : 1 - ripple; }),
        1, 0.9f, 0);
}

TEST(PlanVolumes, EvenDensityTakesTheHomogeneousPathAndNoOtherDoes) {
    const Knobs knobs = preview();
    const formats::Scene even = tests::scene_of(box_of_cells(0)),
                         rippled = tests::scene_of(box_of_cells(1e-4));
    const VolumePlan plan = plan_volumes(even, knobs), other = plan_volumes(rippled, knobs);
    EXPECT_NE(plan.entries.at(0).reason.find("closed form"), std::string::npos);
    EXPECT_EQ(other.entries.at(0).reason.find("closed form"), std::string::npos);
    const VolumeWork less = count_volume_work(even, plan.layouts, knobs).at(0),
                     more = count_volume_work(rippled, other.layouts, knobs).at(0);
    EXPECT_LT(less.depth_steps, 0.75 * more.depth_steps);
    EXPECT_EQ(less.nodes, more.nodes);
}

formats::Scene scene_of_blob(float sigma_t, float albedo, float g) {
    return tests::scene_of(tests::make_volume(tests::make_blob(0.5, 0.125), sigma_t, albedo, g));
}

VolumeWork work_of(const formats::Scene& scene, const Knobs& knobs) {
    return count_volume_work(scene, plan_volumes(scene, knobs).layouts, knobs).front();
}

void expect_within(double predicted, double counted, double factor) {
    EXPECT_GT(predicted, counted / factor);
    EXPECT_LT(predicted, counted * factor);
}

TEST(VolumeWork, NodesAndRowsAreThoseOfTheFile) {
    const formats::Scene scene = scene_of_blob(4, 0.9f, 0.5f);
    const Knobs knobs = tests::small_knobs(Quality::draft, 4);
    const VolumeWork work = work_of(scene, knobs);
    const formats::Volumes volumes = tests::bake_volumes_of(scene, knobs);
    EXPECT_EQ(work.nodes, static_cast<double>(volumes.node.size()));
    EXPECT_EQ(work.nodes * (1 + work.terms),
              static_cast<double>(volumes.rows.row_offset.size() - 1));
    EXPECT_EQ(work.bricks, static_cast<double>(volumes.records[0].brick_count));
}

TEST(VolumeWork, FlightsAreThoseOfAllNodesWithinAFactorOfTwo) {
    constexpr std::uint64_t kWalks = 8;
    for (const float sigma_t : {1.0f, 8.0f}) {
        for (const float albedo : {0.5f, 0.99f}) {
            for (const float g : {0.0f, 0.85f}) {
                const formats::Scene scene = scene_of_blob(sigma_t, albedo, g);
                const Knobs knobs = tests::small_knobs(Quality::draft, 4);
                const VolumeWork work = work_of(scene, knobs);
                const DensitySpace space = make_density_space(scene);
                const formats::Volume& volume = scene.volumes[0];
                WalkCount all;
                for (const glm::ivec3 node : make_node_lattice(volume.density, 4).node) {
                    const glm::vec3 at(volume.density.to_scene * glm::dvec4(glm::dvec3(node), 1));
                    for (std::uint64_t w = 0; w < kWalks; ++w) {
                        FlightRandom random(
                            0, RandomStage::volume_costs,
                            1000000 + kWalks * static_cast<std::uint64_t>(all.flights) + w);
                        const WalkCount one = count_walk(space, at, random);
                        all.flights += one.flights;
                        all.collisions += one.collisions;
                    }
                }
                const double share = work.walks / kWalks;
                SCOPED_TRACE(std::to_string(sigma_t) + " " + std::to_string(albedo) + " " +
                             std::to_string(g));
                expect_within(work.flights, share * all.flights, 1.5);
                expect_within(work.collisions, share * all.collisions, 2);
            }
        }
    }
}

// Weights go 1/2, 1/4, and from there each collision ends half of the walks: 2 + 1/2 + 1/4 + ...
TEST(VolumeWork, WalksWithoutAWayOutCollideAsOftenAsRouletteLetsThem) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.25), 100, 0.5f, 0));
    const DensitySpace space = make_density_space(scene);
    constexpr std::uint64_t kWalks = 4000;
    WalkCount sum;
    for (std::uint64_t w = 0; w < kWalks; ++w) {
        FlightRandom random(0, RandomStage::volume_costs, w);
        const WalkCount one = count_walk(space, glm::vec3(0), random);
        sum.flights += one.flights;
        sum.collisions += one.collisions;
    }
    EXPECT_NEAR(sum.collisions / kWalks, 3, 0.1);
    EXPECT_NEAR(sum.flights / kWalks, 4, 0.1);
}

TEST(VolumeWork, StepsAreThoseOfAllNodesWithinAFactorOfTwo) {
    const formats::Scene scene = scene_of_blob(4, 0.9f, 0);
    const Knobs knobs = tests::small_knobs(Quality::draft, 4);
    const VolumeWork work = work_of(scene, knobs);
    const DensitySpace space = make_density_space(scene);
    const formats::Volume& volume = scene.volumes[0];
    const LightCells cells = make_light_cells(8);
    double steps = 0;
    for (const glm::ivec3 node : make_node_lattice(volume.density, 4).node) {
        const glm::vec3 at(volume.density.to_scene * glm::dvec4(glm::dvec3(node), 1));
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const glm::vec3 direction = cells.direction(i);
            const float pitch = glm::length(space.volumes[0].to_index * direction);
            visit_cells(space.volumes[0], at, direction, 1e9f, [&](float, float begin, float end) {
                steps += static_cast<double>(std::ceil((end - begin) * pitch));
                return true;
            });
        }
    }
    expect_within(work.depth_steps, steps, 1.2);
}

TEST(VolumeWork, TimeGrowsWithWalksAndBytesWithCoefficients) {
    const formats::Scene scene = scene_of_blob(4, 0.9f, 0.5f);
    Knobs knobs = tests::small_knobs(Quality::draft, 4);
    const VolumeWork few = work_of(scene, knobs);
    const double seconds = scattering_work({knobs}, few).shared;
    const double once = attenuated_row_bytes(few, knobs), often = scattered_row_bytes(few, knobs);
    Knobs more = knobs;
    more.set(kVolumeWalks, 10 * knobs[kVolumeWalks]);
    more.set(kVolumeCoefficients, 4 * knobs[kVolumeCoefficients]);
    const VolumeWork many = work_of(scene, more);
    EXPECT_NEAR(many.collisions, 10 * few.collisions, 0.02 * many.collisions);
    const double longer = scattering_work({more}, many).shared;
    EXPECT_GT(longer, 5 * seconds);
    EXPECT_LT(longer, 10.2 * seconds);
    EXPECT_GT(attenuated_row_bytes(many, more), 2.5 * once);
    EXPECT_GT(scattered_row_bytes(many, more), 2.5 * often);
    EXPECT_GT(volume_memory(many, more), volume_memory(few, knobs));
}

}  // namespace

}  // namespace opaline::bake
