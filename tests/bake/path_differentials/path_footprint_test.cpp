#include <algorithm>
#include <vector>

#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/physics/path_differentials/path_differential.h"
#include "tests/bake/path_differentials/event_check.h"
#include "tests/bake/path_differentials/path_rules.h"

namespace opaline::bake {
namespace {

using tests::kStill;
using tests::kUp;
using tests::unlimited_rules;

double hull_area(std::vector<glm::dvec2> points) {
    std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x < b.x || (a.x == b.x && a.y < b.y);
    });
    double area = 0;
    for (const double side : {1.0, -1.0}) {
        std::vector<glm::dvec2> chain;
        for (const glm::dvec2& p : points) {
            while (chain.size() > 1) {
                const glm::dvec2 a = chain[chain.size() - 2], b = chain.back();
                if (side * ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) > 0) break;
                chain.pop_back();
            }
            chain.push_back(p);
        }
        for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
            area += side * (chain[i].x * chain[i + 1].y - chain[i + 1].x * chain[i].y) / 2;
        }
    }
    return area;
}

// Paths of perturbed numbers, 8^4 in the box of steps, end in the polygon: the area of their hull.
// The same path in four numbers, traced anew each time.
TEST(PathFootprint, IsTheHullOfPerturbedPaths) {
    const tests::GlossyChain chain;
    const glm::dvec3 axis = tests::lobe_axis(chain);
    const auto ratio = [&](double step) {
        const std::array<double, 4> steps{step / 50, step / 50, step, step};
        std::vector<glm::dvec2> ends, vectors;
        for (int n = 0; n < 4096; ++n) {
            std::array<double, 4> x = chain.x;
            for (std::size_t i = 0; i < 4; ++i) {
                x[i] += steps[i] * ((n >> (3 * i) & 7) / 7.0 - 0.5);
            }
            const auto end = trace_chain(chain, x, axis).P;
            ends.emplace_back(end.x, end.z);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            std::array<tests::Dual, 4> x{chain.x[0], chain.x[1], chain.x[2], chain.x[3]};
            x[i].change = steps[i];
            const glm::dvec3 moved = changes(trace_chain(chain, x, axis).P);
            vectors.emplace_back(moved.x, moved.z);
        }
        return hull_area(ends) / polygon_area(vectors);
    };
    EXPECT_NEAR(ratio(0.02), 1, 0.02);
    EXPECT_NEAR(ratio(0.005), 1, 0.01);
}

// Of a curved receiver the normal turns along the cell, and the directions around it.
TEST(PathFootprint, ReceiversTurnTheirBouncesWithTheirNormal) {
    const glm::dvec3 dP(0.1, 0, 0);
    PathDifferential path;
    add_variable(path, {dP, kStill, 0, 1});
    aim_at_normal(path, glm::dmat3(0.5));  // a sphere of radius 2
    const glm::dvec3 D =
        scatter_in_lobe(path, unlimited_rules(), {.axis = kUp, .u = 0.5, .v = 0.5, .N_g = kUp});
    EXPECT_LT(glm::length(D - kUp), 1e-15);
    EXPECT_LT(glm::length(path.column[0].dD - dP / 2.0), 1e-15);
}

/// A path between two planes at distance 1, with its columns unmerged beside it. Directions are
/// made to depend on positions, so that those of older columns matter.
struct Bounces {
    PathDifferential path;
    std::vector<DifferentialColumn> all;
};

Bounces bounce(int count, const DifferentialRules& rules) {
    tests::RandomInputs random(42);
    Bounces out;
    PathDifferential& path = out.path;
    glm::dvec3 N = kUp;
    for (int i = 0; i < count; ++i) {
        const double u = random.uniform(0.1, 0.9), v = random.uniform(0.1, 0.9);
        for (DifferentialColumn& column : path.columns()) {
            column.dD = glm::cross(column.dP, N) * 0.3;
        }
        for (DifferentialColumn& column : out.all) {
            column.dD = glm::cross(column.dP, N) * 0.3;
        }
        const glm::dvec3 D = scatter_in_lobe(path, rules, {.axis = N, .u = u, .v = v, .N_g = N});
        for (DifferentialColumn& column : out.all) {
            column.dD = carry_with_axis(N, column.dD, D);
        }
        for (std::size_t k = path.count - 2; k < path.count; ++k) {
            out.all.push_back(path.column[k]);
        }
        N = -N;
        const double t = 1 / std::abs(D.y);
        move_to_surface(path, D, N, t);
        for (DifferentialColumn& column : out.all) {
            column.dP = bounded_transfer(D, N, t, column.dP, column.dD);
        }
    }
    return out;
}

double rms_minor(const std::vector<DifferentialColumn>& columns, double step) {
    std::vector<glm::dvec2> vectors;
    for (const DifferentialColumn& column : columns) {
        vectors.emplace_back(step * column.step * column.dP.x, step * column.step * column.dP.z);
    }
    return pair_extent(rms_pair(vectors)).minor;
}

TEST(PathFootprint, OfEightColumnsAtMostIsThatOfAll) {
    for (const int count : {3, 4, 6, 10}) {
        const Bounces local = bounce(count, unlimited_rules());
        EXPECT_LE(local.path.count, 8u);
        EXPECT_EQ(local.path.variables, 2 * count);
        const SurfaceFootprint merged =
            surface_footprint(local.path, unlimited_rules(), kUp, FootprintMode::filter);
        EXPECT_NEAR(merged.extent.minor / rms_minor(local.all, 1), 1, 1e-9) << count;
        // Global steps change after a merge: merged columns follow.
        const DifferentialRules rules = unlimited_rules(1e5);
        const Bounces global = bounce(count, rules);
        const SurfaceFootprint later =
            surface_footprint(global.path, rules, kUp, FootprintMode::filter);
        EXPECT_NEAR(later.extent.minor / rms_minor(global.all, global_step(1e5, 2 * count, 1)), 1,
                    1e-9)
            << count;
    }
}

// Merging keeps the area of the polygon where it happens.
TEST(PathFootprint, MergingKeepsThePolygonsArea) {
    const DifferentialRules rules = unlimited_rules();
    tests::RandomInputs random(43);
    PathDifferential path;
    for (int i = 0; i < 8; ++i) {
        add_variable(path, {random.change_of(kUp), random.change_of(kUp), 0, 0.5});
    }
    const double before = surface_footprint(path, rules, kUp, FootprintMode::polygon).area;
    scatter_in_lobe(path, rules, {.axis = kUp, .u = 0.3, .v = 0.6, .N_g = kUp});
    EXPECT_LE(path.count, 7u);
    EXPECT_NEAR(surface_footprint(path, rules, kUp, FootprintMode::polygon).area, before,
                1e-9 * before);
}

// Hard case: footprints that the linear model cannot mean.
TEST(PathFootprint, IsAtMostAQuarterOfTheScene) {
    PathDifferential path;
    add_variable(path, {{1e9, 0, 0}, kStill, 0, 1});
    add_variable(path, {{0, 0, 1e9}, kStill, 0, 1});
    add_variable(path, {{1e9, 0, 1e9}, kStill, 0, 1});
    for (const FootprintMode mode : {FootprintMode::polygon, FootprintMode::filter}) {
        const SurfaceFootprint at = surface_footprint(path, unlimited_rules(1, 8), kUp, mode);
        EXPECT_NEAR(at.extent.major, 2, 1e-12);
        EXPECT_LE(at.area, 4 + 1e-12);
        EXPECT_GT(at.extent.minor, 0.5);
    }
}

// A square of 0.1 m seen through coordinates of 10 per metre is one unit of the texture wide.
TEST(PathFootprint, IsSeenInTextureCoordinates) {
    PathDifferential path;
    add_variable(path, {{0.1, 0, 0}, kStill, 0, 1});
    add_variable(path, {{0, 0, 0.1}, kStill, 0, 1});
    const SurfaceFootprint at =
        surface_footprint(path, unlimited_rules(), kUp, FootprintMode::filter);
    EXPECT_NEAR(at.area, 0.01, 1e-17);
    const FootprintPair uv = footprint_in_texture(at, {{10, 0}, {0, 0}, {0, 5}});
    EXPECT_NEAR(pair_area(uv), 0.5, 1e-14);
}

}  // namespace
}  // namespace opaline::bake
