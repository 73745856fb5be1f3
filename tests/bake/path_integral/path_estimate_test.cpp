#include "bake/physics/path_integral/quasi_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/path_integral/grid_medium.h"
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

}  // namespace
}  // namespace opaline::bake
