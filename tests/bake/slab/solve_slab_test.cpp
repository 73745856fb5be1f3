#include "bake/physics/slab/solve_slab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/bake/slab/slab_support.h"
#include "tests/support/cloud_table.h"
#include "tests/support/doubled_slab.h"
#include "tests/support/volume_table.h"

namespace opaline::tests {
namespace {

using bake::SlabFluxes;
using bake::SlabMedium;
using bake::SlabSolution;

TEST(SolveSlab, ReproducesTheHenyeyGreensteinRowsOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "slab_hg");
    for (const CloudRow& row : rows) {
        const SlabSolution slab =
            solve_one(henyey_greenstein_slab(row.number("g_hg"), row.number("albedo")),
                      row.number("tau"), cosine_of_degrees(row.number("theta_l_deg")));
        const double value =
            row.text("quantity") == "R" ? slab.total.reflectance[0] : slab.total.transmittance[0];
        const bool photons = row.text("method") == "monte_carlo_1sigma";
        EXPECT_NEAR(value, row.value(), (photons ? 4 : 1) * row.error()) << row.name();
    }
}

TEST(SolveSlab, ReproducesVanDeHulstAndTheSlabsOfTheVolumeTable) {
    OPALINE_VOLUME_ROWS(beam, "R_normal");
    for (const auto& [quantity, of] :
         {std::pair<const char*, double (*)(const SlabFluxes&)>{
              "R_normal", [](const SlabFluxes& f) { return f.reflectance[0]; }},
          {"T_normal", [](const SlabFluxes& f) { return f.transmittance[0]; }},
          {"R_diffuse", [](const SlabFluxes& f) { return f.mean_reflectance; }},
          {"T_diffuse", [](const SlabFluxes& f) { return f.mean_transmittance; }}}) {
        for (const VolumeRow& row : read_volume_rows(quantity)) {
            const SlabSolution slab =
                solve_one(henyey_greenstein_slab(row.number("g"), row.number("albedo")),
                          row.number("sigma_t") * row.number("size"), 1);
            // Published values: their rounding. Even light needs more streams than a beam.
            const double rounding = row.number_or_zero("stderr");
            EXPECT_NEAR(of(slab.total), row.value(), std::max(1e-6, 1.1 * rounding)) << row.id();
        }
    }
}

TEST(SolveSlab, WithoutAbsorptionNothingIsLost) {
    for (const double g : {-0.5, 0.0, 0.75, 0.95}) {
        for (const double depth : {1e-9, 1e-3, 0.1, 1.0, 30.0, 1e3}) {
            for (const double cosine : {1e-6, 1e-3, 0.1, 0.5, 1.0}) {
                const SlabSolution slab =
                    solve_one(henyey_greenstein_slab(g, 1), depth, cosine, 0, 16);
                const double sum = slab.total.reflectance[0] + slab.total.transmittance[0];
                EXPECT_NEAR(sum, 1, 1e-9) << g << " " << depth << " " << cosine;
                EXPECT_NEAR(slab.total.mean_reflectance + slab.total.mean_transmittance, 1, 1e-9);
            }
        }
    }
}

TEST(SolveSlab, NoDepthTransmitsAllAndAbsorbersTransmitByBeer) {
    const SlabSolution nothing = solve_one(henyey_greenstein_slab(0.5, 1), 0, 0.3, 2, 8);
    EXPECT_EQ(nothing.total.reflectance[0], 0);
    EXPECT_EQ(nothing.total.transmittance[0], 1);
    EXPECT_NEAR(nothing.order[0].transmittance[0], 1, 1e-12);
    EXPECT_NEAR(nothing.order[1].transmittance[0], 0, 1e-12);
    const SlabSolution black = solve_one({{1.0}, 0}, 2, 0.5, 0, 8);
    EXPECT_EQ(black.total.reflectance[0], 0);
    EXPECT_NEAR(black.total.transmittance[0], std::exp(-4.0), 1e-15);
}

// Chandrasekhar: a half space of isotropic scattering reflects 1 - H(mu) sqrt(1 - albedo), and
// H solves 1 / H(mu) = sqrt(1 - a) + a / 2 int x H(x) / (mu + x) dx.
TEST(SolveSlab, ThickIsotropicSlabsReflectByTheHFunction) {
    const bake::GaussLegendre rule = bake::make_gauss_legendre(64);
    for (const double albedo : {0.3, 0.9, 0.99}) {
        std::vector<double> h(rule.node.size(), 1.0);
        const auto h_at = [&](double mu) {
            double sum = std::sqrt(1 - albedo);
            for (std::size_t i = 0; i < h.size(); ++i) {
                sum += albedo / 2 * rule.weight[i] * rule.node[i] * h[i] / (mu + rule.node[i]);
            }
            return 1 / sum;
        };
        for (int pass = 0; pass < 400; ++pass) {
            std::vector<double> next = h;
            for (std::size_t i = 0; i < h.size(); ++i) {
                next[i] = h_at(rule.node[i]);
            }
            h = next;
        }
        for (const double mu : {0.05, 0.4, 1.0}) {
            EXPECT_NEAR(solve_one({{1.0}, albedo}, 1e3, mu).total.reflectance[0],
                        1 - h_at(mu) * std::sqrt(1 - albedo), 2e-6)
                << albedo << " " << mu;
        }
    }
}

TEST(SolveSlab, HalvedDepthsAreSolvedOnTheWay) {
    const SlabMedium medium = henyey_greenstein_slab(0.8, 0.95);
    const auto chain = solve_slab(medium, {6, 3, {0.3, 0.9}, 16, 3});
    ASSERT_EQ(chain.size(), 4u);
    for (const SlabSolution& slab : chain) {
        const auto alone = solve_slab(medium, {slab.optical_depth, 0, {0.3, 0.9}, 16, 3}).front();
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(slab.total.reflectance[i], alone.total.reflectance[i], 1e-12);
            EXPECT_NEAR(slab.order[2].transmittance[i], alone.order[2].transmittance[i], 1e-9);
        }
    }
    EXPECT_EQ(chain[3].optical_depth, 0.75);
}

TEST(SolveSlab, OrdersAddUpToTheWholeAndOrderZeroIsBeer) {
    for (const double albedo : {1.0, 0.6}) {
        const SlabSolution slab = solve_one(henyey_greenstein_slab(0.7, albedo), 0.8, 0.6, 60, 16);
        double reflected = 0, transmitted = 0;
        for (const SlabFluxes& order : slab.order) {
            reflected += order.reflectance[0];
            transmitted += order.transmittance[0];
            EXPECT_GE(order.reflectance[0], -1e-10);
        }
        EXPECT_NEAR(slab.order[0].transmittance[0], std::exp(-0.8 / 0.6), 1e-10);
        EXPECT_NEAR(reflected, slab.total.reflectance[0], 1e-9);
        EXPECT_NEAR(transmitted, slab.total.transmittance[0], 1e-9);
    }
}

// T_2 of the slab below and itself: even without 1 - R, T keeps its digits (T ~ 1 / depth).
TEST(SolveSlab, HugeDepthsTransmitLikeTheirInverse) {
    const SlabMedium medium = henyey_greenstein_slab(0.85, 1);
    const double far = solve_one(medium, 1e5, 0.5, 0, 16).total.mean_transmittance;
    const double farther = solve_one(medium, 1e6, 0.5, 0, 16).total.mean_transmittance;
    EXPECT_NEAR(far / farther, 10, 0.01);
    // 1 / (1 + 0.75 (1 - g) depth), but for the extrapolation length of 1.42 against 4 / 3
    EXPECT_NEAR(farther * 0.75 * 0.15 * 1e6, 1, 1e-4);
}

TEST(SolveSlab, GrazingLightIsHalfReflectedAtOnceByAThickSlab) {
    // Half of the first events, all at depth 0, send light up. The other half goes down.
    const SlabSolution slab = solve_one(henyey_greenstein_slab(0, 1), 50, 1e-6, 2);
    EXPECT_NEAR(slab.order[0].transmittance[0], 0, 1e-12);
    EXPECT_NEAR(slab.order[1].reflectance[0], 0.5, 2e-5);
    // and what goes down at mu is dimmed by e^-(depth / mu)
    const SlabSolution thin = solve_one(henyey_greenstein_slab(0, 1), 0.5, 1e-6, 2);
    EXPECT_NEAR(thin.order[1].transmittance[0],
                integrate([](double mu) { return std::exp(-0.5 / mu) / 2; }, 0, 1), 1e-4);
}

TEST(SolveSlab, MomentsThatAreNoDensityGiveFiniteNumbers) {
    for (const SlabMedium& medium :
         {SlabMedium{{1, 1, 1, 1, 1, 1}, 1}, {{1, -1, 1, -1, 1, -1, 1}, 1}, {{1, 0, 5}, 0.5}}) {
        const SlabSolution slab = solve_one(medium, 1, 0.5, 2, 2);
        EXPECT_TRUE(std::isfinite(slab.total.reflectance[0]));
        EXPECT_TRUE(std::isfinite(slab.order[1].transmittance[0]));
    }
}

}  // namespace
}  // namespace opaline::tests
