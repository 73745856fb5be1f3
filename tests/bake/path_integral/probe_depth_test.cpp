#include "bake/physics/path_integral/quasi_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "bake/physics/path_integral/grid_medium.h"
#include "tests/bake/path_integral/path_support.h"

namespace opaline::bake {
namespace {

using glm::dvec3;

// Along no axis of a grid, and perpendicular to it.
const dvec3 kAlong = glm::normalize(dvec3(2, 1, -1.3)), kAside = glm::normalize(dvec3(1, -2, 0));

// The blob on a grid of voxels of size * `voxel`, out to 6 sizes. Voxels stand at +- 1/2, 3/2, ...
formats::SparseGrid<float> blob_grid(const tests::Blob& blob, double voxel,
                                     const glm::dmat4& shear = glm::dmat4(1)) {
    const double edge = voxel * blob.size;
    const int bricks = static_cast<int>(std::ceil(6 / voxel / 8));
    const glm::dmat4 to_scene =
        shear * glm::scale(glm::dmat4(1), dvec3(edge)) * glm::translate(glm::dmat4(1), dvec3(0.5));
    return tests::sample_grid([&](dvec3 x) { return blob.extinction(x); }, glm::ivec3(-bricks),
                              glm::ivec3(2 * bricks), to_scene);
}

double depth_through(const formats::SparseGrid<float>& grid, double distance, double size,
                     double step) {
    const GridMedium medium(grid, {1, 0});
    const auto extinction = [&](dvec3 x) { return medium(x).extinction(); };
    return probe_depth(extinction, grid_box(grid), distance * kAside - 5.9 * size * kAlong, kAlong,
                       step);
}

// Between voxels a trilinear function is above one that curves by h^2 / 12 of its Laplacian on
// average. Along a line through a Gaussian the relative error is therefore, to second order,
// h^2 / 12 (p^2 / s^4 - 2 / s^2): at voxels of s / 8 it is 2.6e-3 through the centre.
TEST(ProbeDepth, BlobOnAGridIsAsDeepAsTheTableSaysButForTheSquareOfItsVoxels) {
    OPALINE_VOLUME_ROWS(rows, "tau_infinite_line");
    for (const auto& row : rows) {
        const tests::Blob blob{row.number("sigma_t"), row.number("size")};
        const double distance = row.number("arg") / blob.size;
        for (const double voxel : {0.5, 0.25, 0.125}) {
            const double depth = depth_through(blob_grid(blob, voxel), row.number("arg"), blob.size,
                                               blob.size * voxel / 2);
            const double second_order = voxel * voxel / 12 * (distance * distance - 2);
            EXPECT_NEAR(depth / row.value() - 1, second_order, 0.2 * std::pow(voxel, 4) + 2e-5)
                << row.id() << ' ' << voxel;
        }
    }
}

TEST(ProbeDepth, ShearedGridOfTheSameBlobIsAsDeep) {
    const tests::Blob blob{4, 0.5};
    glm::dmat4 shear(1);
    shear[0] = {0.9, 0, 0.1, 0};
    shear[1] = {0.3, 1.2, 0, 0};
    const double exact = depth_through(blob_grid(blob, 0.125), 0.4, 0.5, 0.03);
    EXPECT_NEAR(depth_through(blob_grid(blob, 0.125, shear), 0.4, 0.5, 0.03) / exact, 1, 1e-3);
}

TEST(ProbeDepth, IsTheSameFromTheOtherSideOfAMirror) {
    const formats::SparseGrid<float> grid = blob_grid({4, 0.5}, 0.5);
    const GridMedium medium(grid, {0.7, 0.3});
    const auto extinction = [&](dvec3 x) { return medium(x).extinction(); };
    VolumeBox box = grid_box(grid);
    box.low = glm::max(box.low, -box.high);
    box.high = -box.low;
    const dvec3 start(box.low.x, 0.3, -0.2), along = glm::normalize(dvec3(0.2, 0, 0.1) - start);
    const double depth = probe_depth(extinction, box, start, along, 0.05);
    EXPECT_GT(depth, 1);
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 mirror(1);
        mirror[axis] = -1;
        EXPECT_NEAR(probe_depth(extinction, box, mirror * start, mirror * along, 0.05) / depth, 1,
                    1e-6);
    }
}

TEST(ProbeDepth, ConvergesWithTheSquareOfItsStep) {
    const tests::Blob blob{4, 0.5};
    const auto extinction = [&](dvec3 x) { return blob.extinction(x); };
    // From within, so that the rule is not that of a periodic function.
    const auto depth = [&](double step) {
        return probe_depth(extinction, tests::cube(3), {0.3, 0.1, -0.2}, kAlong, step);
    };
    const double exact = -std::log(blob.visibility({0.3, 0.1, -0.2}, kAlong));
    EXPECT_NEAR((depth(0.1) - exact) / (depth(0.05) - exact), 4, 0.1);
    EXPECT_NEAR((depth(0.05) - exact) / (depth(0.025) - exact), 4, 0.1);
}

TEST(VolumeBox, RayLeavesItAtAFiniteDistanceInEveryDirectionFromEveryPoint) {
    const VolumeBox box{{-1, -2, -3}, {1, 2, 3}};
    for (const dvec3 x : {dvec3(0), dvec3(1, 2, 3), dvec3(-1, 0, 3), dvec3(0.2, -2, 0)}) {
        for (const dvec3 d :
             {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, -1, -0.0), glm::normalize(dvec3(1, 1, -1)),
              glm::normalize(dvec3(0, 1, 1e-20))}) {
            const double distance = exit_distance(box, x, d);
            ASSERT_TRUE(std::isfinite(distance));
            ASSERT_GE(distance, 0);
            const dvec3 end = glm::abs(x + distance * d) - box.high;
            EXPECT_NEAR(std::max({end.x, end.y, end.z}), 0, 1e-12);
        }
    }
    EXPECT_EQ(exit_distance(box, {1, 0, 0}, {1, 0, 0}), 0);
    EXPECT_EQ(exit_distance(box, {1, 0, 0}, {-1, 0, 0}), 2);
    EXPECT_EQ(exit_distance(box, {1, 0, 0}, {0, 1, 0}), 2);
}

}  // namespace
}  // namespace opaline::bake
