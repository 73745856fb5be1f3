#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/physics/path_integral/least_attenuation.h"
#include "bake/physics/path_integral/turn.h"
#include "tests/bake/path_integral/path_support.h"

namespace opaline::bake {
namespace {

using glm::dvec3;

using std::numbers::pi;

Turn only_turn(dvec3 from, dvec3 to) {
    const Turns turns(from, to);
    EXPECT_EQ(turns.size(), 1u);
    return turns[0];
}

dvec3 in_plane(double angle) {
    return {std::sin(angle), 0, std::cos(angle)};
}

TEST(Turn, ArcsInAHomogeneousMediumEndAsTheTableSays) {
    for (const bool lateral : {false, true}) {
        OPALINE_VOLUME_ROWS(rows, lateral ? "arc_lateral" : "arc_along_v");
        for (const auto& row : rows) {
            const double angle = row.number("arg") * pi / 180;
            const Turn turn{{0, 0, 1}, {1, 0, 0}, in_plane(angle), angle};
            const dvec3 end = tests::arc_end(turn, row.number("size"), row.number("sigma_t"));
            // The table has 12 digits.
            EXPECT_NEAR(lateral ? end.x : end.z, row.value(),
                        1e-12 * std::max(1.0, 5 * row.value()))
                << row.id();
        }
    }
}

TEST(Turn, EndsInTheLastDirection) {
    const dvec3 from = glm::normalize(dvec3(0.3, -0.5, 0.2));
    const dvec3 side = glm::normalize(glm::cross(from, dvec3(1, 0, 0)));
    for (const double angle : {1e-13, 1e-9, 1e-4, 1.0, 2.0, pi - 1e-4, pi - 1e-9, pi}) {
        const dvec3 to = std::cos(angle) * from + std::sin(angle) * side;
        for (const Turn& turn : Turns(from, to)) {
            const dvec3 end = std::cos(turn.angle) * turn.from + std::sin(turn.angle) * turn.aside;
            EXPECT_LT(glm::length(end - to), 2e-12) << angle;
            EXPECT_NEAR(glm::length(turn.aside), 1, 1e-15) << angle;
            EXPECT_NEAR(glm::dot(turn.aside, from), 0, 1e-15) << angle;
        }
    }
}

TEST(Turn, BetweenEqualDirectionsIsNone) {
    const dvec3 v = glm::normalize(dvec3(1, 2, 3));
    const Turn turn = only_turn(v, v);
    EXPECT_EQ(turn.angle, 0);
    EXPECT_LT(glm::length(tests::arc_end(turn, 2, 4) - 0.5 * v), 1e-15);
}

TEST(Turn, BetweenOppositeDirectionsStandsForAllPlanes) {
    for (const dvec3 v : {dvec3(0, 0, 1), dvec3(0, 0, -1), glm::normalize(dvec3(1, -2, 0.1))}) {
        const Turns turns(v, -v);
        ASSERT_EQ(turns.size(), 4u);
        glm::dmat3 sum(0);
        dvec3 mean(0);
        for (const Turn& turn : turns) {
            EXPECT_EQ(turn.angle, pi);
            mean += turn.aside;
            sum += glm::outerProduct(turn.aside, turn.aside);
        }
        EXPECT_LT(glm::length(mean), 1e-15);
        for (int i = 0; i < 3; ++i) {
            const dvec3 even = 2.0 * (dvec3(i == 0, i == 1, i == 2) - v[i] * v);
            EXPECT_LT(glm::length(sum[i] - even), 1e-14);
        }
    }
}

TEST(ForwardSplit, OfHenyeyGreensteinIsThatOfTheMathematics) {
    const ForwardSplit split = split_forward_peak(expand_henyey_greenstein(0.9, 6), 4);
    EXPECT_NEAR(split.share, 0.590, 5e-4);
    ASSERT_EQ(split.rest.lambda.size(), 5u);
    const double expected[] = {1, 0.756, 0.536, 0.338, 0.160};
    for (std::size_t l = 0; l < 5; ++l) {
        EXPECT_NEAR(split.rest.lambda[l], expected[l], 5e-4) << l;
    }
}

TEST(ForwardSplit, MakesNarrowPeaksModerate) {
    for (const double g : {0.9, 0.99, 0.9999}) {
        const ForwardSplit split = split_forward_peak(expand_henyey_greenstein(g, 6), 4);
        EXPECT_LE(split.rest.lambda[1], 0.8) << g;
    }
}

// Along a path of length s the moment of degree l decays as exp(-c s + b lambda_l s).
TEST(ForwardSplit, KeepsEveryMomentOfLightThatIsScatteredAnyNumberOfTimes) {
    const Coefficients medium{3, 0.2};
    for (const double g : {-0.6, 0.0, 0.5, 0.9, 0.99, 0.9999}) {
        for (const unsigned degree : {1u, 2u, 4u, 8u}) {
            const PhaseSeries series = expand_henyey_greenstein(g, degree + 2);
            const ForwardSplit split = split_forward_peak(series, degree);
            const Coefficients rest = without_peak(medium, split.share);
            EXPECT_EQ(rest.absorption, medium.absorption);
            for (unsigned l = 0; l <= degree; ++l) {
                EXPECT_NEAR(rest.extinction() - rest.scattering * split.rest.lambda[l],
                            medium.extinction() - medium.scattering * series.lambda[l], 1e-14)
                    << g << ' ' << l;
            }
        }
    }
}

TEST(ForwardSplit, BackwardScatteringHasNoForwardPeak) {
    const PhaseSeries series = expand_henyey_greenstein(-0.5, 6);
    const ForwardSplit split = split_forward_peak(series, 4);
    EXPECT_EQ(split.share, 0);
    EXPECT_EQ(split.rest.lambda[3], series.lambda[3]);
}

constexpr double kLengths[] = {0.5, 1.0, 2.0};

double ell_of_least(const Turn& turn, double absorption, double curvature) {
    const auto medium = [&](dvec3) { return Coefficients{1, absorption}; };
    return least_attenuated_path(dvec3(0), turn, 1, kLengths, curvature, medium,
                                 {.box = tests::cube(10), .step = 0.01})
        .ell_total;
}

// With alpha angle^2 = 1 and b = 1 the attenuation is 1 / ell + a ell: 2 + a / 2, 1 + a, 1 / 2 + 2
// a.
TEST(LeastAttenuation, LengthGoesFromTwiceTheDepthToHalfOfItAsAbsorptionGrows) {
    const Turn turn = Turns(dvec3(0, 0, 1), glm::normalize(dvec3(1, 0, 0.3)))[0];
    const double curvature = 1 / (turn.angle * turn.angle);
    EXPECT_EQ(ell_of_least(turn, 0, curvature), 2);
    EXPECT_EQ(ell_of_least(turn, 0.45, curvature), 2);
    EXPECT_EQ(ell_of_least(turn, 0.55, curvature), 1);
    EXPECT_EQ(ell_of_least(turn, 1.9, curvature), 1);
    EXPECT_EQ(ell_of_least(turn, 2.1, curvature), 0.5);
}

// Of three paths that turn toward x the longest one, and it alone, passes beyond z = 0.8: there it
// is dark.
TEST(LeastAttenuation, DarkPlacesOnTheWayAreAvoided) {
    const Turn turn = Turns(dvec3(0, 0, 1), dvec3(1, 0, 0))[0];
    const auto medium = [](dvec3 x) { return Coefficients{1, x.z > 0.8 ? 100.0 : 0.0}; };
    const QuasiPath path =
        least_attenuated_path(dvec3(0), turn, 1, kLengths, printed_curvature(0.5), medium,
                              {.box = tests::cube(10), .step = 0.01});
    EXPECT_GT(tests::arc_end(turn, 2, 1).z, 0.8);
    EXPECT_LT(tests::arc_end(turn, 1, 1).z, 0.8);
    EXPECT_EQ(path.ell_total, 1);
}

}  // namespace

}  // namespace opaline::bake
