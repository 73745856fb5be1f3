#include "bake/physics/slab/low_orders.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/bake/slab/slab_support.h"

namespace opaline::tests {
namespace {

// Once: int over the depth z of both ways, exp(-z / mu_l) exp(-(z or depth - z) / mu_v) dz / mu_v.
// Twice: the second event lies on the folded path, whose optical length is y: half of y.
TEST(LowOrders, AreTheirIntegralsOverTheDepth) {
    for (const double depth : {0.01, 1.0, 8.0}) {
        for (const double light : {0.2, 0.5, 1.0}) {
            for (const double view : {0.1, 0.5, 0.9}) {
                const auto sum = [&](bool transmitted, bool twice) {
                    return integrate(
                        [&](double z) {
                            const double y = z / light + (transmitted ? depth - z : z) / view;
                            return std::exp(-y) / view * (twice ? y / 2 : 1);
                        },
                        0, depth, 64);
                };
                EXPECT_NEAR(bake::reflected_once(depth, light, view), sum(false, false), 1e-12);
                EXPECT_NEAR(bake::transmitted_once(depth, light, view), sum(true, false), 1e-12);
                EXPECT_NEAR(bake::reflected_twice(depth, light, view), sum(false, true), 1e-12);
                EXPECT_NEAR(bake::transmitted_twice(depth, light, view), sum(true, true), 1e-12);
            }
        }
    }
}

TEST(LowOrders, GrazingLightAndViewAreLimits) {
    EXPECT_NEAR(bake::reflected_once(1, 0.5, 0), 1, 1e-11);  // of E p: only the surface is seen
    EXPECT_NEAR(bake::reflected_twice(1, 0.5, 0), 0.5, 1e-11);
    EXPECT_NEAR(bake::transmitted_once(1, 0.5, 0), std::exp(-2.0), 1e-11);
    for (const double depth : {0.0, 1e-300, 1e-3, 1.0, 1e6, 1e300}) {
        for (const double light : {0.0, 1e-30, 1e-3, 1.0}) {
            for (const double view : {0.0, 1e-30, 1e-3, 1.0}) {
                for (const double value : {bake::reflected_once(depth, light, view),
                                           bake::transmitted_once(depth, light, view),
                                           bake::reflected_twice(depth, light, view),
                                           bake::transmitted_twice(depth, light, view)}) {
                    EXPECT_GE(value, 0);
                    EXPECT_LE(value, 1 + 1e-12) << depth << " " << light << " " << view;
                }
            }
        }
    }
}

TEST(LowOrders, SpreadProfileIsNormalisedFromThinToThick) {
    for (const double a : {1e-3, 0.1, 0.6, 1.0, 2.26, 50.0}) {
        const double sum =
            integrate([&](double x) { return 2 * bake::spread_profile(a, x * x) * x * x * 2 * x; },
                      0, 1, 256);
        EXPECT_NEAR(sum, 1, 1e-9) << a;
    }
    // 1 - 2 E_3(a)
    for (const auto& [a, value] :
         {std::pair{0.1, 0.16742}, {0.6, 0.6169}, {1.0, 0.78062}, {2.26, 0.95631}}) {
        EXPECT_NEAR(-std::expm1(-a) / bake::spread_profile(a, 1), value, 5e-5);
    }
    EXPECT_NEAR(bake::spread_profile(0, 0.25), 2, 1e-15);
    EXPECT_NEAR(bake::spread_profile(1e-14, 0.25), 2, 1e-12);
    EXPECT_EQ(bake::spread_profile(1e5, 0.25), 1);
    EXPECT_TRUE(std::isfinite(bake::spread_profile(1, 0)));
    EXPECT_TRUE(std::isfinite(bake::spread_profile(0, 0)));
}

}  // namespace
}  // namespace opaline::tests
