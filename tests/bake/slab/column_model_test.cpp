#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "bake/physics/slab/column_model.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/radiance_table.h"
#include "tests/bake/slab/slab_support.h"
#include "tests/support/cloud_table.h"

namespace opaline::tests {
namespace {

using bake::column_orders;
using bake::ColumnFit;
using bake::ColumnModel;
using bake::OrderShares;

TEST(ColumnModelTest, HoldsThePrintedParametersOfThePaper) {
    OPALINE_CLOUD_ROWS(rows, "appendixB");
    for (const CloudRow& row : rows) {
        const std::string& quantity = row.text("quantity");
        bool found = false;
        for (double degrees = 0; degrees <= 90; degrees += 10) {
            if (row.number_or("theta_l_deg", degrees) != degrees) continue;
            const ColumnModel m = bake::paper2006_at(degrees);
            const std::map<std::string, double> value = {
                {"b", m.length / (1 + m.length)}, {"beta", m.beta}, {"c_per_m", m.decay},
                {"kappa_c_per_m", m.extinction},  {"t", m.forward}, {"r", m.back}};
            ASSERT_TRUE(value.contains(quantity)) << row.name();
            EXPECT_NEAR(value.at(quantity), row.value(), 1e-12) << row.name();
            found = true;
        }
        EXPECT_TRUE(found) << row.name();
    }
}

TEST(ColumnModelTest, ParametersBetweenAnglesAreLinear) {
    const ColumnModel between = bake::paper2006_at(72.5);
    EXPECT_NEAR(between.back, 0.75 * 0.17 + 0.25 * 0.3554, 1e-12);
    EXPECT_NEAR(between.decay, 0.75 * 0.0133 + 0.25 * 0.028, 1e-12);
    EXPECT_EQ(bake::paper2006_at(91).forward, 0.1);
}

// Events at k and l below it: forward twice, or back and forth with the second event above the
// first; what leaves goes on for the rest of the column.
TEST(ColumnModelTest, OrdersAreIntegralsOverTheirEvents) {
    const ColumnModel model{1, 1, 1, 1.59, 0.7165, 0.17};
    for (const double thickness : {0.01, 0.3, 1.0, 4.0}) {
        const double k = model.extinction, t = model.forward, r = model.back;
        const auto through = [&](double length) { return std::exp(-k * length); };
        const OrderShares shares = column_orders(model, thickness);
        const auto inside = [&](const auto& f) { return integrate(f, 0, thickness, 4); };
        EXPECT_NEAR(shares.transmitted[1],
                    inside([&](double a) { return k * t * through(a) * through(thickness - a); }),
                    1e-12);
        EXPECT_NEAR(shares.reflected[1],
                    inside([&](double a) { return k * r * through(a) * through(a); }), 1e-12);
        const double forward_twice = inside([&](double a) {
            return integrate([&](double b) { return k * k * t * t * through(thickness) + 0 * b; },
                             a, thickness, 4);
        });
        const double back_and_forth = inside([&](double a) {
            return integrate(
                [&](double b) {  // down to a, up to b < a, down from b
                    return k * k * r * r * through(a) * through(a - b) * through(thickness - b);
                },
                0, a, 4);
        });
        EXPECT_NEAR(shares.transmitted[2], forward_twice + back_and_forth, 1e-12);
        const double turned_second = inside([&](double a) {
            return integrate([&](double b) { return k * k * t * r * through(b) * through(b); }, a,
                             thickness, 4);
        });
        const double turned_first = inside([&](double a) {
            return integrate(
                [&](double b) { return k * k * r * t * through(a) * through(a) + 0 * b; }, 0, a, 4);
        });
        EXPECT_NEAR(shares.reflected[2], turned_second + turned_first, 1e-12);
    }
}

TEST(ColumnModelTest, ThePaperSecondOrderNeedsItsSignTurned) {
    // x = 1.59, r = .0547: 3.4e-4, and 6.9e-6 as printed
    const double x = 1.59, r = 0.0547;
    const OrderShares shares = column_orders({1, 1, 1, x, 0, r}, 1);
    EXPECT_NEAR(shares.transmitted[2], 3.4e-4, 5e-6);
    EXPECT_NEAR(column_orders({1, 1, 1, 1e-5, 0, r}, 1).transmitted[2] / (r * r * 1e-10 / 2), 1,
                3e-5);
}

TEST(ColumnModelTest, ThickColumnsApproachTheirLimits) {
    const ColumnModel model{2, 1.2, 0.5, 1.1, 0.8, 0.06};
    for (const double thickness : {1e3, 1e9, 1e300}) {
        const OrderShares shares = column_orders(model, thickness);
        EXPECT_NEAR(shares.reflected[1], 0.03, 1e-15);
        EXPECT_NEAR(shares.reflected[2], 0.024, 1e-15);
        EXPECT_EQ(shares.transmitted[1], 0);
        EXPECT_EQ(shares.transmitted[2], 0);
        EXPECT_NEAR(column_transmittance(model, thickness) * thickness / 2, 1.2, 3e-3);
    }
}

TEST(ColumnModelTest, SharesAreNeverNegativeAndAddUpToOne) {
    for (double degrees = 0; degrees <= 90; degrees += 10) {
        const double cosine = std::max(1e-6, cosine_of_degrees(degrees));
        for (const double thickness : {0.0, 1e-6, 1.0, 20.0, 300.0, 1e5}) {
            const double direct = std::exp(-0.0226 * thickness / cosine);
            const OrderShares shares =
                eval_column_model(bake::paper2006_at(degrees), thickness, direct);
            double sum = 0;
            for (int n = 0; n < 4; ++n) {
                EXPECT_GE(shares.transmitted[n], 0);
                EXPECT_GE(shares.reflected[n], 0);
                sum += shares.transmitted[n] + shares.reflected[n];
            }
            EXPECT_NEAR(sum, 1, 1e-12) << degrees << " " << thickness;
            EXPECT_EQ(shares.transmitted[0], direct);
        }
    }
    EXPECT_EQ(eval_column_model(bake::paper2006_at(0), 0, 1).transmitted[0], 1);
}

TEST(ColumnModelTest, FitOfAnyPhaseFunctionIsNearItsSlabs) {
    const double cosines[] = {1, 0.5};
    for (const double g : {0.0, 0.6, 0.85}) {
        const auto medium = henyey_greenstein_slab(g, 1);
        const auto fits = fit_column_models(medium, cosines, bake::column_fit_depths(), 16);
        for (std::size_t i = 0; i < fits.size(); ++i) {
            const ColumnFit& fit = fits[i];
            EXPECT_LT(fit.max_transmittance, 0.02) << g << " " << cosines[i];
            EXPECT_LT(fit.max_orders, 0.05) << g << " " << cosines[i];
            const double depth = 5;  // not one of those it was fitted at
            const double exact = solve_one(medium, depth, cosines[i], 0, 16).total.transmittance[0];
            EXPECT_NEAR(column_transmittance(fit.model, depth), exact,
                        2 * fit.max_transmittance + 1e-3);
        }
    }
}

using bake::SlabTable;

const bake::SlabMedium& tabulated_medium() {
    static const bake::SlabMedium medium = henyey_greenstein_slab(0.73, 1);
    return medium;
}

const SlabTable& slab_table() {
    static const SlabTable table = make_slab_table(tabulated_medium());
    return table;
}

TEST(SlabTableTest, InterpolatesTheFluxUpTo80DegreesWithin3In1000OfTheLight) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    double largest = 0, squares = 0;
    constexpr int kPoints = 25;
    for (int i = 0; i < kPoints; ++i) {
        const double x = 0.02 + 0.96 * uniform(generator), depth = x / (1 - x);
        const double cosine = cosine_of_degrees(80 * uniform(generator));
        const OrderShares shares = eval_slab_table(slab_table(), depth, cosine);
        const auto slab = solve_one(tabulated_medium(), depth, cosine, 3, 32);
        const double transmitted = shares.transmitted[0] + shares.transmitted[1] +
                                   shares.transmitted[2] + shares.transmitted[3];
        const double error = transmitted - slab.total.transmittance[0];
        largest = std::max(largest, std::abs(error));
        squares += error * error;
        for (std::size_t n = 1; n < 3; ++n) {
            EXPECT_NEAR(shares.transmitted[n], slab.order[n].transmittance[0], 4e-3)
                << depth << " " << cosine;
            EXPECT_NEAR(shares.reflected[n], slab.order[n].reflectance[0], 2e-3)
                << depth << " " << cosine;
        }
    }
    RecordProperty("largest", std::to_string(largest));
    EXPECT_LT(largest, 3e-3);
    EXPECT_LT(std::sqrt(squares / kPoints), 1e-3);
}

TEST(SlabTableTest, EvenLightIsInterpolatedWithin1In1000) {
    for (const double depth : {0.01, 0.2, 1.3, 7.0, 40.0, 900.0}) {
        const auto slab = solve_one(tabulated_medium(), depth, 1, 0, 32);
        EXPECT_NEAR(eval_mean_transmittance(slab_table(), depth), slab.total.mean_transmittance,
                    1e-3)
            << depth;
    }
}

TEST(SlabTableTest, NoDepthIsExactlyClear) {
    for (const double cosine : {0.0, 0.3, 1.0}) {
        const OrderShares shares = eval_slab_table(slab_table(), 0, cosine);
        EXPECT_EQ(shares.transmitted[0], 1);
        for (int n = 1; n < 4; ++n) {
            EXPECT_EQ(shares.transmitted[n], 0);
            EXPECT_EQ(shares.reflected[n], 0);
        }
    }
    EXPECT_EQ(eval_mean_transmittance(slab_table(), 0), 1);
}

TEST(SlabTableTest, SharesAddUpToOneEverywhere) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double depth : {0.0, 1e-300, 1e-6, 0.4, 20.0, 1e9, kInfinity}) {
        for (const double cosine : {0.0, 1e-9, 1e-3, 0.17, 0.6, 1.0}) {
            const OrderShares shares = eval_slab_table(slab_table(), depth, cosine);
            double sum = 0;
            for (int n = 0; n < 4; ++n) {
                EXPECT_GE(shares.transmitted[n], 0) << depth << " " << cosine;
                EXPECT_GE(shares.reflected[n], 0) << depth << " " << cosine;
                sum += shares.transmitted[n] + shares.reflected[n];
            }
            EXPECT_NEAR(sum, 1, 1e-6) << depth << " " << cosine;
        }
    }
}

TEST(SlabTableTest, GrazingLightOnInfiniteDepthIsHalfReflectedAtOnce) {
    const OrderShares shares =
        eval_slab_table(slab_table(), std::numeric_limits<double>::infinity(), 0);
    EXPECT_NEAR(shares.reflected[1], 0.5, 1e-3);
    EXPECT_NEAR(shares.transmitted[3], 0, 1e-5);
}

}  // namespace

}  // namespace opaline::tests
