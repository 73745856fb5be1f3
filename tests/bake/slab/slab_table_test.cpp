#include "bake/physics/slab/radiance_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "bake/physics/slab/low_orders.h"
#include "tests/bake/slab/slab_support.h"

namespace opaline::tests {
namespace {

using bake::OrderShares;
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
