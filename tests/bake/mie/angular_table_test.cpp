#include "bake/physics/mie/angular_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/physics/phase.h"
#include "tests/bake/mie/mie_support.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

using tests::kDegree;

AngularTable henyey_table(double g, double step) {
    AngularTable table;
    const int last = static_cast<int>(std::lround(180 / step));
    for (int i = 0; i <= last; ++i) {
        table.angle.push_back(i == last ? pi : i * step * kDegree);
        table.value.push_back(henyey_greenstein(std::cos(table.angle.back()), g));
    }
    return table;
}

TEST(AngularTable, IntegralsAreThoseOfHenyeyAndGreenstein) {
    const AngularTable table = henyey_table(0.7, 0.1);
    EXPECT_NEAR(integrate_table(table), 1, 1e-5);  // linear between rows
    EXPECT_NEAR(integrate_cosine(table), 0.7, 1e-5);
    // int_mu^1 2 pi p = (1 - g^2) / (2 g) (1 / (1 - g) - 1 / sqrt(1 + g^2 - 2 g mu))
    for (const double angle : {0.5, 5.0, 40.0, 123.4, 180.0}) {
        const double mu = std::cos(angle * kDegree), g = 0.7;
        const double within =
            (1 - g * g) / (2 * g) * (1 / (1 - g) - 1 / std::sqrt(1 + g * g - 2 * g * mu));
        EXPECT_NEAR(integrate_within(table, angle * kDegree), within, 1e-5) << angle;
    }
    EXPECT_EQ(integrate_within(table, 0), 0);
}

// A table of two rows is linear in the cosine over the whole sphere.
TEST(AngularTable, LinearFunctionIsExactWithTwoRows) {
    const AngularTable table{{0, pi}, {2 / (4 * pi), 0}};
    EXPECT_NEAR(integrate_table(table), 1, 1e-15);
    EXPECT_NEAR(integrate_cosine(table), 1.0 / 3, 1e-15);
    EXPECT_NEAR(eval_table(table, pi / 2), 1 / (4 * pi), 1e-16);
    const std::vector<double> moments = table_moments(table, 60);
    EXPECT_NEAR(moments[0], 1, 1e-12);
    EXPECT_NEAR(moments[1], 1.0 / 3, 1e-12);
    for (std::size_t l = 2; l < moments.size(); ++l) {
        EXPECT_NEAR(moments[l], 0, 1e-9) << l;
    }
}

TEST(AngularTable, MomentsArePowersOfGAndGiveTheFunctionBack) {
    const AngularTable table = henyey_table(0.6, 0.05);
    const std::vector<double> moments = table_moments(table, 100);
    for (std::size_t l = 0; l < 30; ++l) {
        EXPECT_NEAR(moments[l], std::pow(0.6, l), 2e-6) << l;
    }
    const std::vector<double> angles{0, 0.3, 1.0, 2.0, pi};
    const std::vector<double> values = sum_moments(moments, angles);
    for (std::size_t i = 0; i < angles.size(); ++i) {
        EXPECT_NEAR(values[i] / henyey_greenstein(std::cos(angles[i]), 0.6), 1, 1e-3);
    }
}

TEST(AngularTable, ThinTableErrsByNoMoreThanItsTolerance) {
    const AngularTable table = henyey_table(0.9, 0.02);
    const AngularTable thin = thin_table(table, 0.002);
    EXPECT_LT(thin.angle.size(), table.angle.size() / 20);
    EXPECT_EQ(thin.angle.front(), 0);
    EXPECT_EQ(thin.angle.back(), pi);
    for (std::size_t i = 0; i < table.angle.size(); ++i) {
        EXPECT_NEAR(eval_table(thin, table.angle[i]) / table.value[i], 1, 0.002001)
            << table.angle[i];
    }
    EXPECT_EQ(thin_table(table, 0).angle.size(), table.angle.size());
}

// cos(a) - cos(b) of small angles has no digits left in the difference of rounded cosines.
TEST(AngularTable, CosinesOfSmallAnglesKeepTheirDigits) {
    EXPECT_NEAR(cosine_difference(0, 1e-9) / 5e-19, 1, 1e-12);
    EXPECT_NEAR(cosine_difference(1e-6, 2e-6) / 1.5e-12, 1, 1e-9);
    EXPECT_NEAR(cosine_difference(0, pi), 2, 1e-15);
}

}  // namespace
}  // namespace opaline::bake
