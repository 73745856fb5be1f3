#include "bake/physics/path_integral/quasi_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/bake/path_integral/path_support.h"

namespace opaline::bake {
namespace {

using glm::dvec3;

using std::numbers::pi;
const auto kVisit = [](const PathStep&) { return true; };

Turn turn_between(dvec3 from, dvec3 to) {
    return Turns(from, to)[0];
}

auto homogeneous(double scattering, double absorption = 0) {
    return [=](dvec3) { return Coefficients{scattering, absorption}; };
}

// Position at a scattering depth, between the middles of two steps.
template <class Medium>
dvec3 position_at(const QuasiPath& path, const Medium& medium, double ell,
                  const MarchLimits& limits) {
    PathStep before{path.start}, after = before;
    march_quasi_path(path, medium, limits, [&](const PathStep& step) {
        before = after;
        after = step;
        return step.ell < ell;
    });
    return before.position +
           (ell - before.ell) / (after.ell - before.ell) * (after.position - before.position);
}

TEST(QuasiPath, InABlobPassesThroughThePositionsOfTheTable) {
    for (const int axis : {0, 1, 2}) {
        for (const char* total : {"2", "3"}) {
            const std::string quantity = std::string("mpp_end_") + "xyz"[axis] + "_ltot" + total;
            OPALINE_VOLUME_ROWS(rows, quantity);
            for (const auto& row : rows) {
                const tests::Blob blob{row.number("sigma_t"), row.number("size")};
                const QuasiPath path{
                    tests::vector_of(row, "p"),
                    turn_between(tests::vector_of(row, "v"), tests::vector_of(row, "l")),
                    std::stod(total)};
                const dvec3 end = position_at(path, blob, row.number("arg"),
                                              {.box = tests::cube(10), .step = 1e-3});
                EXPECT_NEAR(end[axis], row.value(), 1e-5) << row.id();
            }
        }
    }
}

TEST(QuasiPath, InAHomogeneousMediumIsAnArcAndThenStraight) {
    const double b = 3, total = 2, angle = pi / 3;
    const Turn turn = turn_between({0, 0, 1}, {std::sin(angle), 0, std::cos(angle)});
    const dvec3 centre = total / (b * angle) * turn.aside;
    const dvec3 end = tests::arc_end(turn, total, b);
    double first_straight = 0;
    const PathEnd last = march_quasi_path(
        {dvec3(0), turn, total}, homogeneous(b),
        {.box = tests::cube(10), .step = 1e-3, .length = 2}, [&](const PathStep& step) {
            if (step.ell < total) {
                EXPECT_NEAR(glm::length(step.position - centre), total / (b * angle), 1e-6);
            } else {
                const dvec3 from_end = step.position - end;
                EXPECT_LT(glm::length(glm::cross(from_end, turn.to)), 1e-6);
                first_straight = first_straight > 0 ? first_straight : step.ell;
            }
            return true;
        });
    EXPECT_NEAR(first_straight, total, 4e-3);
    EXPECT_LT(glm::length(last.direction - turn.to), 1e-12);
    EXPECT_NEAR(last.length, 2, 1e-12);
    EXPECT_NEAR(last.ell, 6, 1e-10);
}

TEST(QuasiPath, IncrementalTurnEndsAtItsAngle) {
    for (const double angle : {1e-6, 0.5, 2.0, pi - 1e-6}) {
        const Turn turn = turn_between({0, 0, 1}, {0, std::sin(angle), std::cos(angle)});
        // Not quite to the end of the turn, after 100 000 steps.
        const PathEnd end =
            march_quasi_path({dvec3(0), turn, 1 + 1e-9}, homogeneous(1),
                             {.box = tests::cube(10), .step = 1e-5, .length = 1}, kVisit);
        EXPECT_NEAR(glm::length(end.direction), 1, 1e-10);
        EXPECT_LT(glm::length(end.direction - turn.to), 1e-8);
    }
}

TEST(QuasiPath, ConvergesWithTheSquareOfTheStep) {
    const tests::Blob blob{6, 1, 0.9};
    const QuasiPath path{{0.3, 0.2, -2}, turn_between({0, 0, 1}, {0, 0.6, -0.8}), 3};
    struct Result {
        PathEnd end;
        double integral;
    };
    const auto march = [&](double step) {
        double sum = 0;
        const PathEnd end = march_quasi_path(
            path, blob, {.box = tests::cube(10), .step = step, .length = 2.2},
            [&](const PathStep& at) {
                sum += at.depth * std::exp(-at.absorption - 0.3 * at.ell) * at.position.y;
                return true;
            });
        return Result{end, sum};
    };
    const Result exact = march(1e-5);
    const auto errors = [&](double step) {
        const Result result = march(step);
        return std::vector{glm::length(result.end.position - exact.end.position),
                           std::abs(result.end.ell - exact.end.ell),
                           std::abs(result.end.absorption - exact.end.absorption),
                           std::abs(result.integral - exact.integral)};
    };
    const std::vector<double> coarse = errors(0.02), fine = errors(0.0025);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        EXPECT_NEAR(coarse[i] / fine[i], 64, 8) << i;
        EXPECT_LT(fine[i], 1e-4) << i;
    }
}

TEST(QuasiPath, InEmptySpaceIsStraightAndGathersNothing) {
    const Turn turn = turn_between({0, 0, 1}, {1, 0, 0});
    const PathEnd end = march_quasi_path({dvec3(0), turn, kShortestTurn}, homogeneous(0),
                                         {.box = tests::cube(1), .step = 0.1}, kVisit);
    EXPECT_LT(glm::length(end.position - dvec3(0, 0, 1)), 1e-12);
    EXPECT_EQ(end.ell, 0);
    EXPECT_EQ(end.absorption, 0);
    // And to a cloud beyond the void.
    const auto beyond = [](dvec3 x) { return Coefficients{x.z > 0.5 ? 1.0 : 0.0, 0}; };
    const dvec3 met =
        position_at({dvec3(0), turn, 1}, beyond, 0.01, {.box = tests::cube(1), .step = 1e-3});
    EXPECT_NEAR(met.x, 0, 1e-3);
    EXPECT_NEAR(met.z, 0.51, 1e-3);
}

TEST(QuasiPath, ThatBeginsWhereItLeavesTurnsAtOnce) {
    const Turn turn = turn_between({0, 0, 1}, {1, 0, 0});
    const PathEnd end =
        march_quasi_path({{0, 0, 1}, turn, kShortestTurn}, homogeneous(2),
                         {.box = {dvec3(-1), dvec3(1, 1, 2)}, .step = 1e-3}, kVisit);
    EXPECT_EQ(end.direction, turn.to);
    EXPECT_LT(glm::length(end.position - dvec3(1, 0, 1)), 1e-3);
}

TEST(QuasiPath, LeavesTheBoxThroughTheFaceThatItMeetsFirst) {
    const Turn turn = turn_between({0, 0, 1}, {0, 0.6, -0.8});
    const VolumeBox box = tests::cube(1);
    for (const double b : {0.0, 0.1, 1.0, 10.0, 1e3}) {
        const PathEnd end = march_quasi_path({dvec3(0), turn, 2}, homogeneous(b),
                                             {.box = box, .step = 0.01}, kVisit);
        const dvec3 face = glm::abs(end.position);
        EXPECT_NEAR(std::max({face.x, face.y, face.z}), 1, 1e-4) << b;
    }
    const PathEnd outward =
        march_quasi_path({{0, 0, 1}, turn, 2}, homogeneous(1), {.box = box, .step = 0.01}, kVisit);
    EXPECT_EQ(outward.length, 0);
}

TEST(QuasiPath, InAnyDensityEndsWithFiniteDepthsInFewSteps) {
    const Turn turn = turn_between({0, 0, 1}, {0, 1, 0});
    for (const double b : {1e-300, 1e-12, 1.0, 1e6, 1e12, 1e100}) {
        int steps = 0;
        const PathEnd end = march_quasi_path(
            {{0, 0, -1}, turn, 2 * b}, homogeneous(b, b / 100),
            {.box = tests::cube(1), .step = 0.05}, [&](const PathStep& step) {
                EXPECT_TRUE(std::isfinite(step.ell) && std::isfinite(step.absorption));
                return ++steps < 10000;
            });
        EXPECT_LT(steps, 40 + 1100 * 1.1) << b;
        EXPECT_TRUE(std::isfinite(end.ell)) << b;
        EXPECT_NEAR(end.absorption / end.ell, 0.01, 1e-10) << b;
    }
}

// A plane arc that turns one way by at most pi is convex together with its chord, and no convex
// curve in a box is longer than the circle whose diameter is the box's. So a march ends without a
// cap, however dense the medium is and however little it absorbs.
TEST(QuasiPath, TurnsByAtMostPiSoItLeavesItsBoxWithinTheCircumferenceOfASphereAroundIt) {
    const VolumeBox box = tests::cube(1);
    const double step = 0.05, circle = pi * glm::length(box.high - box.low);
    const auto speckled = [](double b) {
        return [b](dvec3 x) {
            const bool dense = std::fmod(std::abs(x.x * 31 + x.y * 17 + x.z * 43), 2) < 1;
            return Coefficients{dense ? b : 1e-3 * b, 0};
        };
    };
    for (const double b : {1e-6, 1.0, 50.0, 1e5}) {
        for (int i = 0; i < 200; ++i) {
            const auto direction = [](double u, double v) {
                const double z = 2 * u - 1, r = std::sqrt(1 - z * z);
                return dvec3(r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), z);
            };
            const auto spread = [i](double by) { return std::fmod(0.5 + by * i, 1.0); };
            const dvec3 from = direction(spread(0.7548776662), spread(0.5698402910));
            const Turn turn =
                turn_between(from, direction(spread(0.8191725134), spread(0.6710436067)));
            int steps = 0;
            const PathEnd end = march_quasi_path(
                {-0.9 * from / std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)}),
                 turn, b * 2 * spread(0.6180339887)},
                speckled(b), {.box = box, .step = step},
                [&](const PathStep&) { return ++steps < 100000; });
            EXPECT_LE(end.length, circle) << b << ' ' << i;
            // Steps that the density limits are few: each adds a quarter of the depth so far.
            EXPECT_LT(steps, 4 * circle / step) << b << ' ' << i;
        }
    }
}

TEST(QuasiPath, StepsIntoADenseCloudAreShort) {
    const auto wall = [](dvec3 x) { return Coefficients{x.z > 0.055 ? 1e4 : 0.0, 0}; };
    double deepest = 0;
    march_quasi_path({dvec3(0), turn_between({0, 0, 1}, {0, 0, 1}), 1}, wall,
                     {.box = tests::cube(1), .step = 0.1}, [&](const PathStep& step) {
                         deepest = std::max(deepest, step.depth / std::max(1.0, step.ell));
                         return true;
                     });
    EXPECT_LE(deepest, 0.5);
}

}  // namespace
}  // namespace opaline::bake
