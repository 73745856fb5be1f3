#include "bake/effects/volumes/node_lattice.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "formats/opal/volumes.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

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
