#include "bake/effects/volumes/volume_work.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

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
