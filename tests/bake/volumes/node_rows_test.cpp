#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/node_rows.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/encode/select_coefficients.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/volumes.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

std::vector<float> random_cells() {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> values(formats::cubemap_texels(8));
    for (float& value : values) {
        value = uniform(engine);
    }
    return values;
}

double kept_energy(const formats::SparseRow& row) {
    double sum = 0;
    for (const auto* values : {&row.value, &row.average}) {
        for (const float v : *values) {
            sum += static_cast<double>(v) * static_cast<double>(v);
        }
    }
    return sum;
}

TEST(NodeRows, WhatIsLostStaysBelowTheTolerance) {
    const std::vector<float> values = random_cells();
    const double energy = row_energy(values, 8, 16);
    for (const double tolerance : {0.0, 0.01, 0.1}) {
        const NodeEncoder encoder{make_selector(16, 1536), tolerance};
        const formats::SparseRow row = encode_node_rows(encoder, values, 1, 8, 1).front();
        EXPECT_GE(kept_energy(row), (1 - tolerance * tolerance) * energy * (1 - 1e-5));
        EXPECT_LE(kept_energy(row), energy * (1 + 1e-5));
        EXPECT_EQ(row.index.size() < 378, tolerance > 0);
    }
}

TEST(NodeRows, ARowThatAddsNothingToItsNodeKeepsItsAveragesAlone) {
    const std::vector<float> bright = random_cells();
    std::vector<float> values = bright;
    for (const float value : bright) {
        values.push_back(1e-3f * value);
    }
    const NodeEncoder encoder{make_selector(16, 1536), 0.01};
    const auto rows = encode_node_rows(encoder, values, 2, 8, 1);
    EXPECT_GT(rows.at(0).index.size(), 100u);
    EXPECT_TRUE(rows.at(1).index.empty());
    EXPECT_GT(rows[1].average.at(0), 0);
}

// What a row keeps is not an equal share: half as bright, it has fewer of the largest details.
TEST(NodeRows, TheLargestDetailsOfAllRowsTogetherAreKept) {
    const std::vector<float> bright = random_cells();
    std::vector<float> values = bright;
    for (const float value : bright) {
        values.push_back(0.5f * value);
    }
    const auto one = encode_node_rows({make_selector(16, 1536, 0), 0}, bright, 1, 8, 1).front();
    const auto rows = encode_node_rows({make_selector(16, 112, 0), 0}, values, 2, 8, 1);
    EXPECT_EQ(rows.at(0).index.size() + rows.at(1).index.size(), 100u);
    EXPECT_GT(rows[0].index.size(), 1.5 * static_cast<double>(rows[1].index.size()));
    float least = HUGE_VALF;
    for (const auto& row : rows) {
        for (const float v : row.value) {
            least = std::min(least, std::abs(v));
        }
    }
    std::size_t larger = 0;
    for (const float v : one.value) {
        larger += std::abs(v) > least ? 1 : 0;
        larger += 0.5f * std::abs(v) > least ? 1 : 0;
    }
    EXPECT_LT(larger, 100u) << "none that was left out is larger";
    EXPECT_GE(larger, 98u);
}

// Of equal details the first are kept: a node never takes more than it may.
TEST(NodeRows, EqualDetailsDoNotExceedTheirNumber) {
    std::vector<float> values = random_cells();
    values.insert(values.end(), values.begin(), values.begin() + 384);
    const auto rows = encode_node_rows({make_selector(16, 113, 0), 0}, values, 2, 8, 1);
    EXPECT_EQ(rows.at(0).index.size() + rows.at(1).index.size(), 101u);
}

// Where there is little density, or little light comes out, errors are not seen.
TEST(NodeDetails, NodesThatAreSeenKeepMoreThanThoseAtTheEdge) {
    formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.5, 1.0 / 6), 4, 0.9f, 0.5f));
    Knobs knobs = tests::small_knobs(Quality::preview, 2);
    knobs.set(kVolumeWalks, 32);
    knobs.set(kVolumeCoefficients, 96);
    knobs.set(kVolumeTerms, 4);
    const formats::Volumes volumes = tests::bake_volumes_of(scene, knobs);
    const formats::VolumeRecord& record = volumes.records[0];
    const NodeLattice lattice = make_node_lattice(scene.volumes[0].density, 2);
    const std::vector<float> density = node_densities(scene.volumes[0].density, lattice);
    std::array<double, 2> details{}, nodes{};
    for (std::uint32_t i = 0; i < record.node_count; ++i) {
        const std::size_t dense = density[i] > 0.2f ? 1 : 0;
        details[dense] += volumes.rows.row_offset[(i + 1) * record.terms()] -
                          volumes.rows.row_offset[i * record.terms()];
        ++nodes[dense];
    }
    ASSERT_GT(nodes[0], 20);
    ASSERT_GT(nodes[1], 20);
    EXPECT_GT(details[1] / nodes[1], 3 * details[0] / nodes[0]);
    EXPECT_LE(details[0] + details[1], (nodes[0] + nodes[1]) * (96 - 6 * record.terms()));
    EXPECT_GT(details[0] + details[1], 0.9 * (nodes[0] + nodes[1]) * (96 - 6 * record.terms()));
}

class NodeLatticeOf : public testing::TestWithParam<std::uint32_t> {};

TEST_P(NodeLatticeOf, EveryPointWithDensityStandsBetweenEightNodesWhoseMeanPlaceItIs) {
    const formats::SparseGrid<float> grid = tests::make_blob(0.3, 0.07);
    const NodeLattice lattice = make_node_lattice(grid, GetParam());
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::vec3 index =
            40.0f * (glm::vec3(uniform(engine), uniform(engine), uniform(engine)) - 0.5f);
        if (grid.sample(index) <= 0) continue;
        ++inside;
        const NodesAround around = nodes_around(lattice, index);
        ASSERT_TRUE(around.found);
        glm::dvec3 mean(0);
        float sum = 0;
        for (std::size_t c = 0; c < 8; ++c) {
            ASSERT_NE(around.node[c], formats::kNoNode);
            mean +=
                static_cast<double>(around.weight[c]) * glm::dvec3(lattice.node[around.node[c]]);
            sum += around.weight[c];
        }
        EXPECT_NEAR(sum, 1, 1e-6);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(mean[axis], static_cast<double>(index[axis]), 1e-4);
        }
    }
    EXPECT_GT(inside, 50);
}

TEST_P(NodeLatticeOf, NodesStandWhereTheirCornersSay) {
    const NodeLattice lattice = make_node_lattice(tests::make_blob(0.3, 0.07), GetParam());
    const std::size_t along = 8 / GetParam() + 1, corners = along * along * along;
    ASSERT_EQ(lattice.corner.size(), lattice.brick.size() * corners);
    std::set<std::uint32_t> used;
    for (std::size_t i = 0; i < lattice.corner.size(); ++i) {
        if (lattice.corner[i] == formats::kNoNode) continue;
        used.insert(lattice.corner[i]);
        const std::size_t c = i % corners;
        const glm::ivec3 at = 8 * lattice.brick[i / corners] +
                              static_cast<int>(GetParam()) *
                                  glm::ivec3(c % along, c / along % along, c / along / along);
        EXPECT_EQ(lattice.node[lattice.corner[i]], at);
    }
    EXPECT_EQ(used.size(), lattice.node.size());
}

INSTANTIATE_TEST_SUITE_P(Spacings, NodeLatticeOf, testing::Values(1u, 2u, 4u, 8u));

TEST(NodeLattice, NodesStandCloserInDenserMedia) {
    const formats::SparseGrid<float> grid = tests::make_ball_grid(1, 0.1);
    EXPECT_EQ(choose_spacing(grid.value, grid.to_scene, 1e-3, 1), 8u);
    EXPECT_EQ(choose_spacing(grid.value, grid.to_scene, 2, 1), 4u);
    EXPECT_EQ(choose_spacing(grid.value, grid.to_scene, 4, 1), 2u);
    EXPECT_EQ(choose_spacing(grid.value, grid.to_scene, 1e4, 1), 1u);
}

}  // namespace

}  // namespace opaline::bake
