#include "bake/physics/phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/gauss_legendre.h"
#include "tests/bake/scattering/table_support.h"
#include "tests/support/volume_table.h"

namespace opaline::bake {
namespace {

TEST(HenyeyGreenstein, ValuesAreThoseOfTheTable) {
    tests::expect_rows("hg", [](const tests::ReferenceRow& row) {
        return henyey_greenstein(row.number("cos"), row.number("g"));
    });
}

// Over theta = pi x^4, which spreads the forward peak.
TEST(HenyeyGreenstein, MeanSquareAngleIsThatOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "hg_mean_square_angle");
    const GaussLegendre rule = make_gauss_legendre(600);
    for (const auto& row : rows) {
        double mean = 0;
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double x = rule.node[i], theta = std::numbers::pi * x * x * x * x;
            mean += rule.weight[i] * 4 * std::numbers::pi * x * x * x * 2 * std::numbers::pi *
                    std::sin(theta) * theta * theta *
                    henyey_greenstein(std::cos(theta), row.number("g"));
        }
        EXPECT_NEAR(mean, row.value(), 1e-9) << row.id();
    }
}

TEST(HenyeyGreenstein, PeakIsExactForExtremeAsymmetry) {
    for (const double g : {0.99, 0.9999}) {
        EXPECT_NEAR(henyey_greenstein(1, g) * 4 * std::numbers::pi * (1 - g) * (1 - g) / (1 + g), 1,
                    1e-10);
    }
}

}  // namespace
}  // namespace opaline::bake
