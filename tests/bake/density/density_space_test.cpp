#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "bake/effects/volumes/volume_walks.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

using tests::make_blob;
using tests::make_volume;
using tests::scene_of;

TEST(DensitySpace, ABeamThroughAGaussianBlobHasItsOpticalDepthHoweverTheGridIsTurned) {
    formats::Volume blob = make_volume(make_blob(0.5, 0.5 / 16), 4, 1, 0);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3));
    for (const glm::dmat4& frame : {glm::dmat4(1), turn}) {
        formats::Volume placed = blob;
        placed.density.to_scene = frame * blob.density.to_scene;
        const formats::Scene scene = scene_of(placed);
        const DensitySpace space = make_density_space(scene);
        EXPECT_TRUE(space.is_grey);
        for (const float p : {0.0f, 0.3f}) {
            const glm::vec3 from(frame * glm::dvec4(-3, p, 0, 1));
            const glm::vec3 along(frame * glm::dvec4(1, 0, 0, 0));
            const double expected = 4 * 0.5 * std::sqrt(2 * std::numbers::pi) *
                                    std::exp(-static_cast<double>(p * p) / 0.5);
            EXPECT_NEAR(optical_depth(space, from, along)[0], expected, 3e-3 * expected);
        }
    }
}

TEST(DensitySpace, FlightsSurviveAsBeerAndLambertSay) {
    const formats::Scene scene = scene_of(make_volume(make_blob(0.5, 0.05), 1.5f, 1, 0));
    const DensitySpace space = make_density_space(scene);
    tests::UnitNumbers random(1);
    const glm::vec3 from(-3, 0.2f, 0.1f), along(1, 0, 0);
    constexpr int kFlights = 20000;
    int through = 0;
    for (int i = 0; i < kFlights; ++i) {
        through += sample_flight(space, 0, from, along, 10, random).happens ? 0 : 1;
    }
    const double expected = std::exp(-static_cast<double>(optical_depth(space, from, along)[0]));
    const double error = std::sqrt(expected * (1 - expected) / kFlights);
    EXPECT_NEAR(through / static_cast<double>(kFlights), expected, 4 * error);
}

TEST(DensitySpace, TwoVolumesAtOnePlaceAreOneOfBothDensities) {
    formats::Scene twice = scene_of(make_volume(make_blob(0.5, 0.1), 1, 1, 0));
    twice.volumes.push_back(twice.volumes.front());
    const formats::Scene dense = scene_of(make_volume(make_blob(0.5, 0.1), 2, 1, 0));
    const DensitySpace two = make_density_space(twice), one = make_density_space(dense);
    const glm::vec3 from(-3, 0.1f, 0), along(1, 0, 0);
    EXPECT_NEAR(optical_depth(two, from, along)[0], optical_depth(one, from, along)[0], 1e-5);
    tests::UnitNumbers random(2);
    double mean[2] = {};
    constexpr int kFlights = 20000;
    for (int i = 0; i < kFlights; ++i) {
        mean[0] += static_cast<double>(sample_flight(two, 0, from, along, 10, random).distance);
        mean[1] += static_cast<double>(sample_flight(one, 0, from, along, 10, random).distance);
    }
    EXPECT_NEAR(mean[0] / kFlights, mean[1] / kFlights, 4 * 3.5 / std::sqrt(kFlights));
}

// Voxels of 1 m, 48 along an edge, all of density 1; `ripple`: every other voxel is that much less.
formats::Volume even_box(double ripple) {
    return make_volume(
        formats::fill_grid(
            glm::ivec3(-24), glm::ivec3(24), 1.0,
            [&](glm::ivec3 at) { return (at.x + at.y + at.z) % 2 == 0 ? 1.0 : 1 - ripple; }),
        0.05f, 0.9f, 0);
}

TEST(DensitySpace, DepthsThroughEvenDensityAreInClosedForm) {
    const formats::Scene scene = scene_of(even_box(0)), rippled = scene_of(even_box(1e-4));
    const DensitySpace even = make_density_space(scene), uneven = make_density_space(rippled);
    EXPECT_GT(even_share(even.volumes.front()), 0.3);
    EXPECT_EQ(even_share(uneven.volumes.front()), 0);
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> uniform(-20, 20);
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 from(uniform(engine), uniform(engine), uniform(engine));
        const glm::vec3 along =
            glm::normalize(glm::vec3(uniform(engine), uniform(engine), uniform(engine)));
        const float closed = optical_depth(even, from, along)[0];
        EXPECT_NEAR(optical_depth(uneven, from, along)[0] / closed, 1, 2e-3);
    }
    // Straight out: 24 m, and half of the last voxel's fall to 0.
    const float expected = 0.05f * 24.5f;
    EXPECT_NEAR(optical_depth(even, glm::vec3(0), glm::vec3(0, 0, 1))[0], expected,
                8 * 6e-8f * expected);
}

TEST(DensitySpace, FlightsThroughEvenDensityAreThoseOfTheGridWithFewerNumbers) {
    const formats::Scene scene = scene_of(even_box(0)), rippled = scene_of(even_box(1e-4));
    const DensitySpace even = make_density_space(scene), uneven = make_density_space(rippled);
    double mean[2] = {}, drawn[2] = {};
    constexpr int kFlights = 20000;
    for (const std::size_t is_rippled : {0u, 1u}) {
        tests::UnitNumbers random(6);
        for (int i = 0; i < kFlights; ++i) {
            const Collision hit = sample_flight(is_rippled != 0 ? uneven : even, 0, glm::vec3(0),
                                                glm::vec3(0.6f, 0, 0.8f), 1000, random);
            mean[is_rippled] += hit.happens ? static_cast<double>(hit.distance) : 0;
        }
        drawn[is_rippled] = random.drawn;
    }
    EXPECT_NEAR(mean[0] / kFlights, mean[1] / kFlights, 4 * 12 / std::sqrt(kFlights));
    EXPECT_LT(drawn[0], 0.8 * drawn[1]);
}

TEST(DensitySpace, NoPointIsDenserThanItsCellSays) {
    const formats::Scene scene = scene_of(make_volume(make_blob(0.3, 0.07), 1, 1, 0));
    const DensitySpace space = make_density_space(scene);
    const DensityVolume& volume = space.volumes.front();
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> uniform(-1.3f, 1.3f);
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 from(uniform(engine), uniform(engine), uniform(engine));
        const glm::vec3 along =
            glm::normalize(glm::vec3(uniform(engine), uniform(engine), uniform(engine)));
        float covered = 0;
        visit_cells(volume, from, along, 10, [&](float bound, float begin, float end) {
            for (const float share : {0.001f, 0.3f, 0.8f, 0.999f}) {
                const float t = begin + share * (end - begin);
                EXPECT_LE(volume.density(from + t * along), bound * 1.0001f);
            }
            covered += end - begin;
            return true;
        });
        EXPECT_LE(covered, 10.0f);
    }
}

TEST(DensitySpace, RaysAlongAxesAndFromFacesEndWhereTheGridDoes) {
    const formats::Scene scene = scene_of(make_volume(make_blob(0.3, 0.07), 1, 1, 0));
    const DensitySpace space = make_density_space(scene);
    for (const glm::vec3 along : {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0, 0, 1)}) {
        for (const glm::vec3 from : {glm::vec3(0), -0.56f * along, 1e6f * along, -0.07f * along}) {
            EXPECT_TRUE(std::isfinite(optical_depth(space, from, along)[0]));
        }
        EXPECT_NEAR(optical_depth(space, glm::vec3(0), along)[0],
                    optical_depth(space, glm::vec3(0), -along)[0], 2e-3);
    }
}

TEST(DensitySpace, MediaOfAMillionMeanFreePathsAVoxelEndFlightsAtOnce) {
    const formats::Scene scene = scene_of(make_volume(make_blob(0.3, 0.07), 1e9f, 1, 0));
    const DensitySpace space = make_density_space(scene);
    tests::UnitNumbers random(4);
    const Collision hit = sample_flight(space, 0, {-3, 0, 0}, {1, 0, 0}, 10, random);
    EXPECT_TRUE(hit.happens);
    EXPECT_LT(random.drawn, 5000);
}

TEST(Attenuation, LightReachesTheCentreOfABallAlikeFromAllSides) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.05), 2, 1, 0));
    const DensitySpace space = make_density_space(scene);
    const LightCells cells = make_light_cells(8);
    std::vector<float> v(cells.size());
    gather_attenuation(space, tests::empty_space(), cells, glm::vec3(0), v);
    for (const float value : v) {
        EXPECT_NEAR(value, std::exp(-2.0), 0.01 * std::exp(-2.0));
    }
}

TEST(Attenuation, DepthsAreKeptToATwoThousandth) {
    DepthTable table = make_depth_table(2, 8, 1);
    const std::vector<float> v{1, 0.5f, 1e-3f, 0, 0.9f, 1e-6f, 0.25f, 1e-30f};
    set_depths(table, 1, 0, v);
    const LightCells cells = make_light_cells(2);
    for (std::size_t i = 0; i < v.size(); ++i) {
        const float depth = static_cast<float>(table.codes(1, 0)[i]) * DepthTable::kStep;
        EXPECT_NEAR(std::exp(-depth), v[i], 5e-4 * static_cast<double>(v[i]) + 2e-7);
    }
}

TEST(Attenuation, LightBetweenNodesHasTheMeanOfTheirDepths) {
    const LightCells cells = make_light_cells(2);
    DepthTable table = make_depth_table(2, cells.size(), 1);
    set_depths(table, 0, 0, std::vector<float>(cells.size(), 0.5f));
    set_depths(table, 1, 0, std::vector<float>(cells.size(), 0.1f));
    const ScaledPhase phase = scale_phase(tests::hg(0.4));
    ScatteredLight light;
    light.depth.fill(table.codes(0, 0));
    light.depth[5] = table.codes(1, 0);
    light.node_weight.fill(0.1f);
    light.node_weight[5] = 0.3f;
    light.direction = {0, 0.6f, 0.8f};
    light.phase = &phase.monomial;
    light.weight = {2, 3, 0};
    std::vector<float> sum(2 * cells.size(), 1.0f);
    add_scattered(light, cells, 2, sum.data());
    const float v = std::pow(0.5f, 0.7f) * std::pow(0.1f, 0.3f);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const float value = eval_scaled(phase, glm::dot(light.direction, cells.direction(i))) * v;
        EXPECT_NEAR(sum[i], 1 + 2 * value, 2e-4);
        EXPECT_NEAR(sum[cells.size() + i], 1 + 3 * value, 2e-4);
    }
}

}  // namespace

}  // namespace opaline::bake
