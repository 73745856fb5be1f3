#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/path_integral/grid_medium.h"
#include "bake/physics/path_integral/quasi_path.h"
#include "bake/physics/path_integral/zonal_table.h"
#include "bake/physics/phase.h"
#include "tests/bake/path_integral/path_support.h"

namespace opaline::bake {
namespace {

using glm::dvec3;

using std::numbers::pi;

ZonalTable table_of(PathKernel kernel, double g) {
    return make_zonal_table(kernel, expand_henyey_greenstein(g, 400));
}

// A point and two directions.
struct PathQuery {
    dvec3 position{0};      // [m], in the limits' box
    dvec3 onward{0, 0, 1};  // unit; from `position` away from the eye
    dvec3 light{0, 0, 1};   // unit; toward the distant light
};

// Light from afar that a medium scatters toward the eye [1/sr, per unit irradiance measured
// perpendicular to its direction]: two scatterings or more. Table of PathKernel::ray: radiance at
// the position, corrected [Premoze2003] (18) with the sum over directions in closed form
// (README.md, "Radiance"). Of PathKernel::source: radiance scattered at the position, per unit b.
// `length`: of paths, in scattering depths onward.
template <class Medium, class Visibility>
double estimate_scattered(const ZonalTable& table, const PathQuery& query, const Medium& medium,
                          const MarchLimits& limits, double length, Visibility&& visibility) {
    const auto scattering = [&](dvec3 x) { return Coefficients(medium(x)).scattering; };
    const double onward =
        probe_depth(scattering, limits.box, query.position, query.onward, limits.step);
    const ZonalRow kernel = interpolate_row(table, glm::dot(query.onward, query.light));
    const Turns turns(query.onward, query.light);
    double sum = 0;
    for (const Turn& turn : turns) {
        sum += gather_along_path({query.position, turn, std::max(length * onward, kShortestTurn)},
                                 medium, limits, kernel, visibility);
    }
    return sum / static_cast<double>(turns.size());
}

template <class Medium>
double estimate(const ZonalTable& table, const PathQuery& query, const Medium& medium,
                const MarchLimits& limits, double length = 1) {
    return estimate_scattered(table, query, medium, limits, length,
                              [&](dvec3 x) { return medium.visibility(x, query.light); });
}

double estimate_row(const tests::VolumeRow& row, PathKernel kernel, int steps) {
    const double size = row.number("size");
    const PathQuery query{tests::vector_of(row, "p"), tests::vector_of(row, "v"),
                          tests::vector_of(row, "l")};
    const ZonalTable table = table_of(kernel, row.number("g"));
    const double length = row.number("arg");
    if (row.cell.at("geometry") == "sphere") {
        return estimate(table, query,
                        tests::Ball{row.number("sigma_t"), size, row.number("albedo")},
                        {.box = tests::cube(size), .step = 2 * size / steps}, length);
    }
    EXPECT_EQ(row.cell.at("geometry"), "blob") << row.id();
    return estimate(table, query,
                    tests::Blob{row.number("sigma_t"), size, row.number("albedo"), 4 * size},
                    {.box = tests::cube(4 * size), .step = 8 * size / steps}, length);
}

TEST(PathEstimate, LightOfTwoScatteringsOrMoreIsThatOfTheTable) {
    for (const PathKernel kernel : {PathKernel::ray, PathKernel::source}) {
        OPALINE_VOLUME_ROWS(rows, kernel == PathKernel::ray ? "pi_L2plus" : "pi_J2plus");
        for (const auto& row : rows) {
            // The surface of a sphere is a jump, in which the march is of first order.
            const bool smooth = row.cell.at("geometry") == "blob";
            EXPECT_NEAR(estimate_row(row, kernel, smooth ? 400 : 1600) / row.value(), 1,
                        smooth ? 2e-5 : 5e-3)
                << row.id();
        }
    }
}

const tests::Blob kBlob{6, 0.5, 0.95, 2};
const MarchLimits kLimits{.box = tests::cube(2), .step = 0.02};
const dvec3 kView = glm::normalize(dvec3(0.2, 0.9, -0.4));

TEST(PathEstimate, OnAGridIsThatOfTheMediumThatTheGridSamples) {
    const double edge = 0.05;
    const glm::dmat4 to_scene = glm::translate(glm::scale(glm::dmat4(1), dvec3(edge)), dvec3(0.5));
    const auto grid = tests::sample_grid([&](dvec3 x) { return kBlob.extinction(x); },
                                         glm::ivec3(-5), glm::ivec3(10), to_scene);
    const GridMedium medium(grid, {kBlob.albedo, 1 - kBlob.albedo});
    const PathQuery query{{0.1, -0.7, 0}, kView, {0, 0, 1}};
    const ZonalTable table = table_of(PathKernel::source, 0.75);
    const auto extinction = [&](dvec3 x) { return medium(x).extinction(); };
    const MarchLimits limits{.box = grid_box(grid), .step = edge};
    const double value = estimate_scattered(table, query, medium, limits, 1, [&](dvec3 x) {
        return std::exp(-probe_depth(extinction, limits.box, x, query.light, edge));
    });
    EXPECT_NEAR(value / estimate(table, query, kBlob, kLimits), 1, 5e-3);
}

TEST(PathEstimate, AroundTheAxisOfARoundBodyNoDirectionIsDistinguished) {
    const ZonalTable table = table_of(PathKernel::source, 0.75);
    const dvec3 aside = glm::normalize(glm::cross(kView, dvec3(1, 0, 0)));
    const auto value = [&](dvec3 view, dvec3 light) {
        return estimate(table, {-0.8 * view, view, light}, kBlob, kLimits);
    };
    for (const double angle : {0.0, 1e-13, 1e-9, pi - 1e-9, pi - 1e-13, pi}) {
        const double tilted = value(kView, std::cos(angle) * kView + std::sin(angle) * aside);
        EXPECT_GT(tilted, 0) << angle;
        EXPECT_NEAR(tilted / value({0, 0, 1}, {0, 0, angle < 1 ? 1 : -1}), 1, 1e-5) << angle;
    }
}

TEST(PathEstimate, OfAThinMediumGrowsWithTheSquareOfItsDensity) {
    const PathQuery query{{0.1, -0.7, 0}, kView, {0, 0, 1}};
    const ZonalTable table = table_of(PathKernel::ray, 0.75);
    const auto value = [&](double density) {
        return estimate(table, query, tests::Blob{density, 0.5, 0.95, 2}, kLimits);
    };
    EXPECT_GT(value(1e-12), 0);
    EXPECT_NEAR(value(1e-9) / value(1e-12), 1e6, 1);
    EXPECT_EQ(value(0), 0);
}

TEST(PathEstimate, OfAnyDensityIsFiniteAndNotNegative) {
    for (const PathKernel kernel : {PathKernel::ray, PathKernel::source}) {
        for (const double g : {-0.9, -0.3, 0.0, 0.9}) {
            const ZonalTable table = table_of(kernel, g);
            for (const double density : {1e-300, 1e-20, 1.0, 800.0, 1e6, 1e30}) {
                for (const dvec3 light : {kView, -kView, dvec3(0, 0, 1)}) {
                    const double value = estimate(table, {{0.1, -0.7, 0}, kView, light},
                                                  tests::Blob{density, 0.5, 0.99, 2}, kLimits);
                    EXPECT_TRUE(std::isfinite(value)) << g << ' ' << density;
                    EXPECT_GE(value, 0) << g << ' ' << density;
                    EXPECT_LT(value, 3) << g << ' ' << density;
                }
            }
        }
    }
}

// Without absorption everything under light of radiance 1 has radiance 1. Path integration keeps
// that to 15 %.
TEST(PathEstimate, BallInAWhiteFurnaceIsWhiteWithin15Percent) {
    const GaussLegendre rule = make_gauss_legendre(160);
    struct Case {
        double g, depth;
    };
    for (const auto& [g, depth] :
         {Case{0.5, 1}, Case{0.5, 4}, Case{0.75, 2}, Case{0.75, 10}, Case{0.9, 5}, Case{0.9, 20}}) {
        const tests::Ball ball{depth / 2};
        const ZonalTable table = table_of(PathKernel::ray, g);
        const MarchLimits limits{.box = tests::cube(1), .step = 0.01};
        double once = 0, more = 0;
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double cosine = 2 * rule.node[i] - 1;
            const dvec3 light(std::sqrt(1 - cosine * cosine), 0, cosine);
            const double solid_angle = 4 * pi * rule.weight[i];
            more += solid_angle * estimate(table, {{0, 0, -1}, {0, 0, 1}, light}, ball, limits);
            const Turn straight = Turns({0, 0, 1}, {0, 0, 1})[0];
            const double phase = henyey_greenstein(cosine, g);
            const auto at_once = [&](double ell) { return std::exp(-ell) * phase; };
            once +=
                solid_angle * gather_along_path({{0, 0, -1}, straight, 1}, ball, limits, at_once,
                                                [&](dvec3 x) { return ball.visibility(x, light); });
        }
        EXPECT_NEAR(std::exp(-depth) + once + more, 1, 0.15) << g << ' ' << depth;
    }
}

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
