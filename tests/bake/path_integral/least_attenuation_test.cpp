#include "bake/physics/path_integral/least_attenuation.h"

#include <gtest/gtest.h>

#include "tests/bake/path_integral/path_support.h"

namespace opaline::bake {
namespace {

using glm::dvec3;

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
