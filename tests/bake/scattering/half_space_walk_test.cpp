#include "bake/scattering/half_space_walk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/scattering/fresnel.h"
#include "bake/scattering/half_space_once.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

TEST(HalfSpaceWalk, AgreesWithIndependentlyMeasuredReflectances) {
    // scattering/README.md, "Half space": eta, albedo, single, multiple; standard error 0.001.
    const double rows[][4] = {{1.0, .80, .164, .178},
                              {1.3, .30, .0235, .0072},
                              {1.3, .80, .0629, .1188},
                              {1.3, .95, .0740, .3263},
                              {1.5, .80, .0411, .0893}};
    for (const auto& [eta, albedo, single, multiple] : rows) {
        const HalfSpaceReflectance r = walk_half_space(albedo, 0, eta, 100000, 1, {});
        EXPECT_NEAR(r.once, single, 0.003) << eta << " " << albedo;
        EXPECT_NEAR(r.rest, multiple, 0.004) << eta << " " << albedo;
    }
}

TEST(HalfSpaceWalk, SingleScatteringPerAlbedoIsThatOfTheTable) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "ss_halfspace_reflectance_per_albedo");
    for (const auto& row : rows) {
        if (row.input.at("jac") != "exact") continue;
        const auto r = walk_half_space(1e-2, 0, row.number("eta"), 200000, 3, {});
        EXPECT_NEAR(r.once / 1e-2, row.expected, 0.005) << row.name();
        // 32 nodes across the square root at the critical angle.
        EXPECT_NEAR(half_space_once(row.number("eta")), row.expected, 1e-4) << row.name();
    }
}

TEST(HalfSpaceWalk, NothingIsLostWithoutAbsorption) {
    for (const double eta : {1.0, 1.3}) {
        const auto r = walk_half_space(1, 0, eta, 4000, 1, {});
        // Paths that go deep return late; nearly all return within the event limit.
        EXPECT_NEAR(r.once + r.rest, 1 - fresnel_moments(eta).external, 0.03) << eta;
    }
}

TEST(SlabWalk, ConservativeSlabLosesNothingAndTransmitsByItsTransportThickness) {
    for (const double eta : {0.8, 1.0, 1.4}) {
        for (const double thickness : {0.05, 1.0, 8.0}) {
            const SlabShares s = walk_slab(1, 0.5, eta, thickness, 40000, 2, {});
            EXPECT_NEAR(s.once + s.rest + s.through + s.straight, 1 - fresnel_moments(eta).external,
                        0.006)
                << eta << " " << thickness;
        }
    }
    // 4/3 / (tau' + 2 * 0.7104), asymptotic in tau'.
    for (const double g : {0.0, 0.8}) {
        const SlabShares s = walk_slab(1, g, 1, 8 / (1 - g), 60000, 2, {});
        EXPECT_NEAR(s.through + s.straight, 4.0 / 3 / (8 + 1.4208), 0.006) << g;
    }
}

// In the limit each path is as likely to scatter as it is long, 2 tau in the mean, and half of that
// goes each way where the phase function is even.
TEST(SlabWalk, ThinSlabScattersInProportionToItsThicknessBothWaysAlike) {
    const SlabShares s = walk_slab(0.8, 0, 1, 0.01, 400000, 3, {});
    const double seen = 2 * 0.8 * 0.01;
    EXPECT_NEAR(s.once + s.rest, 0.5 * seen, 0.1 * seen);
    EXPECT_NEAR(s.through, 0.5 * seen, 0.1 * seen);
    EXPECT_NEAR(s.straight, 1 - 2 * 0.01, 0.002);
    const SlabShares forward = walk_slab(0.8, 0.9, 1, 0.01, 400000, 3, {});
    EXPECT_GT(forward.through, 3 * (forward.once + forward.rest));
}

TEST(SlabWalk, ThickSlabIsAHalfSpace) {
    const SlabShares s = walk_slab(0.9, 0.3, 1.3, 60, 20000, 5, {});
    const HalfSpaceReflectance half = walk_half_space(0.9, 0.3, 1.3, 20000, 5, {});
    EXPECT_NEAR(s.once, half.once, 1e-12);
    EXPECT_NEAR(s.rest, half.rest, 1e-3);
    EXPECT_LT(s.through + s.straight, 1e-3);
}

}  // namespace
}  // namespace opaline::bake
