// Printed forms of [Bouthors2006] as tables. Expected values are those that are known of the
// paper, or are computed here from the paper's equations.
#include "bake/effects/layers/paper_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/effects/layers/layer_error.h"
#include "bake/effects/layers/layer_tables.h"
#include "bake/physics/gauss_legendre.h"
#include "bake/physics/slab/column_model.h"
#include "formats/opal/check_clouds.h"
#include "tests/bake/layers/layer_support.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

formats::Scene paper_scene(float thickness = 100, double effective_radius = 3e-6) {
    formats::Scene scene = layer_scene(thickness, effective_radius);
    scene.layers[0].paper = true;
    return scene;
}

// The droplets of the paper at 650, 550 and 450 nm.
const DropletBands& paper_bands() {
    static const DropletBands kBands =
        *scatter_bands(paper_scene(100, 7e-6).layers[0], {1, 200, 2000}, {});
    return kBands;
}

// R_3+ and T_3+ of appendix A with a row of appendix B, at H = 100 m or the like.
OrderShares printed_shares(unsigned row, double thickness, double straight) {
    const ColumnModel m = paper2006_at(10 * row);
    const double x = m.extinction * thickness, e = std::exp(-x), t = m.forward, r = m.back;
    OrderShares s;
    s.transmitted[0] = straight;
    s.transmitted[1] = t * x * e;
    s.transmitted[2] = t * x * t * x * e / 2 + r * r / 4 * (2 * x - 1 + e * e) * e;
    s.reflected[1] = r / 2 * (1 - e * e);
    s.reflected[2] = r * t / 2 * (1 - (1 + 2 * x) * e * e);
    const double b = 0.9961;
    const double all = (m.beta + (1 - m.beta) * std::exp(-m.decay * thickness)) * b /
                       (thickness - (thickness - 1) * b);
    s.transmitted[3] = std::max(0.0, all - straight - s.transmitted[1] - s.transmitted[2]);
    s.reflected[3] = std::max(0.0, 1 - all - s.reflected[1] - s.reflected[2]);
    return s;
}

TEST(PaperTables, ExtinctionIsAQuarterAboveThatOfMie) {
    for (const DropletBand& band : paper_bands()) {
        EXPECT_NEAR(band.kappa, 0.046181, 1e-5);
        EXPECT_NEAR(band.split.angle, 5 * pi / 180, 1e-12);
    }
    EXPECT_NEAR(paper_bands()[1].mie_kappa, 0.0368, 2e-4);
    EXPECT_NEAR(paper_bands()[1].kappa / paper_bands()[1].mie_kappa, 1.25, 0.01);
    EXPECT_NEAR(paper_bands()[1].split.weight, 0.455, 3e-3);  // the paper says 0.51
}

TEST(PaperTables, PaperDropletsAreAsThickAsTheyAre) {
    const DropletBand& green = paper_bands()[1];
    EXPECT_NEAR(
        paper_thickness(rest_extinction(green.split, green.kappa) * 123, green.split.weight), 123,
        1e-9);
}

TEST(PaperTables, FluxesAreThoseOfTheAppendixAtItsAngles) {
    constexpr SlabTableSize kSize{5, 3, true};  // cosines 0, 1 / 4, 1; depths 0, 1/3, 1, 3, endless
    const double weight = 0.455;
    const SlabTable table = make_paper_fluxes(weight, kSize);
    const double depth = 3, thickness = paper_thickness(depth, weight);
    for (const auto& [column, row, cosine] : {std::tuple{2u, 0u, 1.0}, {0u, 9u, 0.0}}) {
        const std::size_t at = 3 * kSize.cosines + column;
        const double straight = cosine > 0 ? std::exp(-depth / cosine) : 0.0;
        const OrderShares expected = printed_shares(row, thickness, straight);
        EXPECT_NEAR(table.t1[at], expected.transmitted[1], 1e-6);
        EXPECT_NEAR(table.r1[at], expected.reflected[1], 1e-6);
        EXPECT_NEAR(table.t2[at], expected.transmitted[2], 1e-6);
        EXPECT_NEAR(table.r2[at], expected.reflected[2], 1e-6);
        const ColumnModel m = paper2006_at(10 * row);
        EXPECT_NEAR(table.t_ms[at], column_transmittance(m, thickness), 1e-6);
    }
    for (std::size_t j = 0; j < kSize.cosines; ++j) {
        EXPECT_EQ(table.t1[j], 0);
        EXPECT_EQ(table.r1[j], 0);
        EXPECT_EQ(table.t_ms[j], 1);
    }
    EXPECT_EQ(table.mean_t[0], 1);
    EXPECT_TRUE(std::ranges::is_sorted(table.mean_t, std::greater<>{}));
}

// Hemispheric totals of order 2: of the printed form without kappa^2; the rest is R_3+
// and T_3+ of appendix A, as the profile 1 / (2 mu) has the energy that it is given.
TEST(PaperTables, RadianceHasThePrintedEnergies) {
    const struct {
        double thickness;
        unsigned row;
        double reflected, transmitted;
    } cases[] = {{100, 7, 0.149, 0.0263}, {100, 3, 0.0583, 0.114}, {5, 8, 0.153, 0.218}};
    const PeakSplit& split = paper_bands()[1].split;
    const RadianceTable table = make_paper_radiance(split, {64, 96, 1});
    const GaussLegendre rule = make_gauss_legendre(64);
    for (const auto& c : cases) {
        const double depth = 0.022629 * c.thickness;
        const double light = std::cos(10 * c.row * pi / 180);
        const OrderShares printed =
            printed_shares(c.row, paper_thickness(depth, split.weight), std::exp(-depth / light));
        for (const bool below : {false, true}) {
            double sum = 0;
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                const double s = rule.node[i], view = s * s;  // dense at the horizon
                sum += 2 * pi * view * eval_radiance_table(table, depth, light, view, 0, below) /
                       light * rule.weight[i] * 2 * s;
            }
            const double rest = below ? printed.transmitted[3] : printed.reflected[3];
            EXPECT_NEAR(sum - rest, below ? c.transmitted : c.reflected, 4.5e-3)
                << c.thickness << (below ? " below" : " above");
        }
    }
}

// Convolutions multiply the mean cosine; u = 12 (j / (events - 1))^2 = n P_f.
TEST(PaperTables, GlowIsAllLightFromOneEventOn) {
    const PeakSplit& split = paper_bands()[1].split;
    constexpr unsigned kAngles = 256;
    const double u = 12 * 0.25 * 0.25;  // row 1 of 5
    const auto glow = tabulate_paper_glow(split, kAngles, 5);
    const std::vector<double> angle = glow_angles(split, kAngles);
    const double n = u / split.weight;
    ASSERT_GT(n, 1);
    AngularTable row{angle, {glow.begin() + kAngles, glow.begin() + 2 * kAngles}};
    EXPECT_NEAR(integrate_table(row), 1, 0.01);
    const double low = std::pow(integrate_cosine(split.peak), std::floor(n));
    const double high = low * integrate_cosine(split.peak);
    const double expected = 1 - std::lerp(low, high, n - std::floor(n));
    EXPECT_NEAR((integrate_table(row) - integrate_cosine(row)) / expected, 1, 0.05);
    EXPECT_GT(1, -std::expm1(-u)) << "what is not direct light already";
    // Rows below one event, of a table with rows enough.
    const auto fine = tabulate_paper_glow(split, kAngles, 48);
    const double few = 12 * std::pow(5 / 47.0, 2) / split.weight;
    ASSERT_LT(few, 1);
    AngularTable start{angle, {fine.begin() + 5 * kAngles, fine.begin() + 6 * kAngles}};
    EXPECT_NEAR(integrate_table(start), few, 0.02 * few);
}

// Hardly any peak, one that is all, none; narrow and wide.
TEST(PaperTables, AllIsFiniteAndNotNegative) {
    for (const double g : {-0.9, 0.0, 0.9, 0.99}) {
        AngularTable phase;
        for (unsigned i = 0; i <= 1000; ++i) {
            const double angle = pi * i * i / 1e6, c = std::cos(angle);
            phase.angle.push_back(angle);
            phase.value.push_back((1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * c, 1.5)));
        }
        scale_table(phase, 1 / integrate_table(phase));
        for (const double degrees : {0.0, 0.01, 5.0, 20.0}) {
            const PeakSplit split = split_peak(phase, degrees * pi / 180);
            const RadianceTable radiance = make_paper_radiance(split, {4, 8, 4});
            const SlabTable flux = make_paper_fluxes(split.weight, {8, 6, true});
            const auto glow = tabulate_paper_glow(split, 16, 6);
            EXPECT_EQ(glow.empty(), degrees == 0.0);
            for (const auto* values :
                 {&flux.t1, &flux.t2, &flux.r1, &flux.r2, &flux.t_ms, &flux.mean_t}) {
                EXPECT_TRUE(std::ranges::all_of(*values, [](float x) { return x >= 0 && x <= 1; }));
            }
            EXPECT_TRUE(std::ranges::all_of(glow, [](float x) { return x >= 0 && x < 1e9f; }));
            for (const auto* values : {&radiance.reflected, &radiance.transmitted}) {
                EXPECT_TRUE(
                    std::ranges::all_of(*values, [](float x) { return std::abs(x) < 1e4f; }));
            }
            for (const double view : {1e-3, 0.3, 1.0}) {
                for (const double light : {1e-3, 0.3, 1.0}) {
                    const double seen = eval_radiance_table(radiance, 1, light, view, 1, true);
                    EXPECT_TRUE(std::isfinite(seen)) << g << ' ' << degrees;
                }
            }
        }
    }
}

TEST(PaperTables, BakeIsSoundSaysSoAndStatesTheErrorOfTheForms) {
    const BakedLayers baked = bake_layer(paper_scene(), least_layer_knobs());
    const formats::LayerRecord& record = baked.clouds.records[0];
    EXPECT_TRUE(record.is_paper());
    EXPECT_EQ(formats::find_clouds_fault(baked.clouds.view()).what, "");
    EXPECT_EQ(formats::find_cloud_value_fault(baked.clouds.view()).what, "");
    EXPECT_NEAR(record.band[0].kappa, 3e8 * pi * 9e-12, 1e-6);
    const LayerErrorReport error =
        check_layer(baked.clouds.view(), record, baked.droplets[0], 1, {});
    EXPECT_GT(error.tables, 0.15);
    EXPECT_LT(error.tables, 3);
    EXPECT_NE(error.reference.find("printed forms"), std::string::npos);
}

}  // namespace
}  // namespace opaline::bake
