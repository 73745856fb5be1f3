#include "bake/example/density_fields.h"

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

}  // namespace
}  // namespace opaline::bake
