#include "bake/lab/example/density_fields.h"

#include <gtest/gtest.h>

namespace opaline::bake {
namespace {

using formats::SparseGrid;

struct Extent {
    glm::ivec3 low{1 << 20}, high{-(1 << 20)};
    int dense = 0;
};

Extent extent_of(const SparseGrid<float>& grid) {
    Extent extent;
    const glm::ivec3 first = SparseGrid<float>::kSide * grid.first_brick,
                     count = SparseGrid<float>::kSide * grid.extent;
    glm::ivec3 p;
    for (p.z = 0; p.z < count.z; ++p.z) {
        for (p.y = 0; p.y < count.y; ++p.y) {
            for (p.x = 0; p.x < count.x; ++p.x) {
                const float value = grid.at(first + p);
                EXPECT_GE(value, 0);
                EXPECT_LE(value, 1);
                if (value > 0) {
                    extent.low = glm::min(extent.low, first + p);
                    extent.high = glm::max(extent.high, first + p);
                    ++extent.dense;
                }
            }
        }
    }
    return extent;
}

// Nothing is cut off at a side of the box that the field is sampled in.
TEST(DensityFields, SmokeIsWholeAndRisesFromItsBase) {
    constexpr double kBase = 0.1, kVoxel = 0.004;
    const Extent smoke = extent_of(make_smoke_density(kBase));
    EXPECT_GT(smoke.low.x, -50);
    EXPECT_LT(smoke.high.x, 50);
    EXPECT_GT(smoke.low.z, -50);
    EXPECT_LT(smoke.high.z, 50);
    EXPECT_NEAR(smoke.low.y * kVoxel, kBase, 2 * kVoxel);
    EXPECT_NEAR(smoke.high.y * kVoxel, kBase + 0.5, 4 * kVoxel);
    EXPECT_GT(smoke.dense, 50000);
}

TEST(DensityFields, CumulusIsWholeAndStandsOnItsFlatBase) {
    const Extent cloud = extent_of(make_cumulus_density());
    EXPECT_GT(cloud.low.x, -80);
    EXPECT_LT(cloud.high.x, 80);
    EXPECT_GT(cloud.low.z, -60);
    EXPECT_LT(cloud.high.z, 60);
    EXPECT_LT(cloud.high.y, 75);
    EXPECT_EQ(cloud.low.y, 0);
    EXPECT_GT(cloud.dense, 100000);
}

// Voxels of 1, and none between 0 and 1: what is between them falls to 0 over one voxel.
TEST(DensityFields, BlockIsEvenAndStandsOnTheGround) {
    const formats::SparseGrid<float> grid = make_block_density();
    const Extent block = extent_of(grid);
    constexpr double kVoxel = 5e-5;
    EXPECT_NEAR((block.high.x - block.low.x + 1) * kVoxel, 3e-3, 1e-12);
    EXPECT_NEAR((block.high.y - block.low.y + 1) * kVoxel, 1.5e-3, 1e-12);
    EXPECT_NEAR((block.high.z - block.low.z + 1) * kVoxel, 2e-3, 1e-12);
    EXPECT_EQ(block.low.y, 1);
    for (const float value : grid.value) {
        EXPECT_TRUE(value == 0 || value == 1);
    }
}

TEST(DensityFields, NoiseIsWholeAndHasHoles) {
    const formats::SparseGrid<float> grid = make_noise_density();
    const Extent cloud = extent_of(grid);
    EXPECT_GT(cloud.low.x, -32);
    EXPECT_LT(cloud.high.x, 32);
    EXPECT_GE(cloud.low.y, 0);
    EXPECT_GT(cloud.dense, 20000);
    // Holes: of the voxels of the ellipsoid's inner half some are empty.
    int empty = 0, inside = 0;
    for (int x = -16; x <= 16; ++x) {
        for (int y = 11; y <= 31; ++y) {
            for (int z = -12; z <= 12; ++z) {
                ++inside;
                empty += grid.at({x, y, z}) == 0;
            }
        }
    }
    EXPECT_GT(empty, inside / 50);
    EXPECT_LT(empty, inside / 2);
}

}  // namespace
}  // namespace opaline::bake
