#include "bake/scattering/phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/scattering/gauss_legendre.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

TEST(HenyeyGreenstein, ValuesAreThoseOfTheTable) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "hg");
    for (const auto& row : rows) {
        EXPECT_NEAR(henyey_greenstein(row.number("cos"), row.number("g")), row.expected,
                    row.tolerance())
            << row.name();
    }
}

TEST(HenyeyGreenstein, IntegratesToOneWithMeanCosineG) {
    const GaussLegendre rule = make_gauss_legendre(400);
    for (const double g : {-0.9, -0.3, 0.0, 0.5, 0.95}) {
        double total = 0, mean = 0;
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double cosine = 2 * rule.node[i] - 1;
            const double p = 4 * std::numbers::pi * rule.weight[i] * henyey_greenstein(cosine, g);
            total += p;
            mean += p * cosine;
        }
        EXPECT_NEAR(total, 1, 1e-9) << g;
        EXPECT_NEAR(mean, g, 1e-9) << g;
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
