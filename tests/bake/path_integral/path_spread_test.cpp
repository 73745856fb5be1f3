#include "tests/bake/path_integral/path_spread.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/volume_table.h"

namespace opaline::bake {
namespace {

TEST(PathSpread, VariancesAreThoseOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "bridge_variance_per_axis");
    for (const auto& row : rows) {
        const double c = row.number("sigma_t"), albedo = row.number("albedo");
        const double variance =
            bridge_variance(albedo * c, (1 - albedo) * c, row.number("size"), row.number("arg"));
        EXPECT_NEAR(variance / row.value(), 1, 1e-8) << row.id();
    }
}

TEST(PathSpread, WithoutAbsorptionGrowsWithTheCubeOfTheLength) {
    EXPECT_NEAR(bridge_variance(10, 0, 0.02, 3), 10 * 0.02 * 27 / 24, 1e-15);
    EXPECT_EQ(bridge_variance(10, 0, 0.02, 0), 0);
    EXPECT_EQ(bridge_variance(0, 2, 0.02, 3), 0);
}

// Both forms of the code meet at u = 0.05.
TEST(PathSpread, FallsSmoothlyWithAbsorption) {
    const auto variance = [](double u) { return bridge_variance(8, u * u, 1, 1); };
    EXPECT_NEAR(variance(0.05 * (1 + 1e-9)) / variance(0.05 * (1 - 1e-9)), 1, 1e-9);
    double last = variance(0);
    for (double u = 1e-9; u < 1e4; u *= 1.5) {
        EXPECT_LE(variance(u), last * (1 + 1e-12)) << u;
        EXPECT_GT(variance(u), 0) << u;
        last = variance(u);
    }
}

}  // namespace
}  // namespace opaline::bake
