#include "bake/effects/volumes/smooth_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

// Nodes of a block of even density, each with one row of one cell.
struct Block {
    NodeLattice lattice = make_node_lattice(
        formats::fill_grid({0, 0, 0}, {40, 40, 40}, 1.0, [](glm::ivec3) { return 1.0; }), 4);
    std::vector<float> density = std::vector<float>(lattice.node.size(), 1.0f);
    std::vector<WalkedNode> nodes = std::vector<WalkedNode>(lattice.node.size());
    std::vector<NodePairs> pairs =
        find_node_pairs(lattice, density, glm::dmat4(1), tests::empty_space());

    // light(voxel), in both halves with noise of its own.
    template <class Light>
    Block(double noise, Light&& light) {
        std::mt19937 engine(1);
        std::normal_distribution<double> normal(0, 1);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double own = light(glm::dvec3(lattice.node[i]));
            for (std::vector<float>& half : nodes[i].half) {
                half = {static_cast<float>(own + noise * normal(engine))};
            }
            nodes[i].rows = {(nodes[i].half[0][0] + nodes[i].half[1][0]) / 2};
        }
    }
    SmoothingWeights choose() const {
        return choose_smoothing(nodes, pairs, density, 1, {}).weights;
    }
    // RMS of the difference from the light.
    template <class Light>
    double error(const SmoothingWeights& weights, Light&& light) const {
        double sum = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double found = static_cast<double>(smooth_rows(nodes, pairs, i, weights, 1)[0]);
            sum += std::pow(found - light(glm::dvec3(lattice.node[i])), 2);
        }
        return std::sqrt(sum / static_cast<double>(nodes.size()));
    }
};

double slope(glm::dvec3 voxel) {
    return 0.02 * voxel.x - 0.01 * voxel.y + 0.03 * voxel.z;
}

TEST(SmoothRows, LightThatChangesLinearlyStaysAsItIs) {
    const Block block(0, slope);
    SmoothingWeights weights{};
    weights.fill(1);
    EXPECT_LT(block.error(weights, slope), 1e-6);
}

TEST(SmoothRows, NoiseOfNeighboursIsTakenTogether) {
    const Block block(0.5, slope);
    const SmoothingWeights weights = block.choose();
    EXPECT_EQ(weights[0], 1);
    // Of 27 nodes a fifth is left; at the faces of the block, where pairs lack a side, a third.
    EXPECT_LT(block.error(weights, slope), 0.35 * block.error({}, slope));
}

TEST(SmoothRows, LightThatChangesFromNodeToNodeIsKeptWhereItIsNotNoise) {
    const auto chequered = [](glm::dvec3 voxel) {
        return std::lround((voxel.x + voxel.y + voxel.z) / 4) % 2 == 0 ? 1.0 : 0.0;
    };
    EXPECT_EQ(Block(0.05, chequered).choose()[0], 0);
}

TEST(SmoothRows, NoLightIsTakenThroughASurface) {
    formats::Scene scene;
    scene.materials.resize(1);
    formats::Primitive wall;
    wall.position = {{18, -9, -9}, {18, 90, -9}, {18, 90, 90}, {18, -9, 90}};
    wall.normal.assign(4, glm::vec3(1, 0, 0));
    wall.index = {0, 1, 2, 0, 2, 3};
    scene.primitives.push_back(wall);
    const auto rays = RayScene::build(scene, 1);
    ASSERT_TRUE(rays.has_value());
    const auto lit_side = [](glm::dvec3 voxel) { return voxel.x < 18 ? 1.0 : 0.0; };
    Block block(0, lit_side);
    block.pairs = find_node_pairs(block.lattice, block.density, glm::dmat4(1), *rays);
    SmoothingWeights weights{};
    weights.fill(1);
    EXPECT_LT(block.error(weights, lit_side), 1e-6);
}

}  // namespace
}  // namespace opaline::bake
